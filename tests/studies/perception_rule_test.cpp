#include "studies/perception_rule.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "studies/perception_experiment.h"
#include "studies/psychometric.h"

namespace rhexis::studies {
namespace {

std::unique_ptr<Rule> rule(std::string_view name, int trials = 40) {
  return make_rule({.name = std::string(name), .trials = trials, .reversals = name == "staircase" ? 8 : 1 << 20});
}

TEST(Halving, IsThatOfTheThesis) {
  std::mt19937_64 engine(3);
  for (int k = 0; k < 50; ++k) {
    const auto halving = rule("halving");
    double angle = 45.0;
    for (int step = 0; step < 5; ++step) {
      ASSERT_FALSE(halving->is_done());
      EXPECT_DOUBLE_EQ(90.0 - halving->difference(), angle);
      const bool right = draw(engine) < 0.5;
      halving->take(right);
      angle += (right ? 1.0 : -1.0) * (90.0 - angle) / 2.0;  // (5.1), (5.2)
      angle = std::clamp(angle, 1.0, 89.0);
    }
    EXPECT_TRUE(halving->is_done());
  }
}

TEST(Staircase, GoesDownAfterThreeUpAfterOneByATwiceThenItsRoot) {
  const auto stairs = rule("staircase");
  const auto answers = [&](std::initializer_list<bool> all) {
    for (const bool right : all) stairs->take(right);
    return stairs->difference();
  };
  EXPECT_EQ(stairs->difference(), 45.0);
  EXPECT_EQ(answers({true, true}), 45.0);
  EXPECT_EQ(answers({true}), 22.5);
  EXPECT_EQ(answers({true, true, true}), 11.25);
  EXPECT_DOUBLE_EQ(answers({true, true, false}), 11.25 * std::sqrt(2.0));
  EXPECT_DOUBLE_EQ(answers({false}), 22.5);
  EXPECT_DOUBLE_EQ(answers({true, true, true}), 22.5 / std::sqrt(2.0));
  EXPECT_FALSE(stairs->estimate().has_value()) << "two turns only";
  EXPECT_DOUBLE_EQ(answers({false}), 22.5);
  EXPECT_DOUBLE_EQ(*stairs->estimate(), 22.5 / std::sqrt(2.0));
  EXPECT_FALSE(stairs->is_done());
  for (int k = 0; k < 5; ++k) k % 2 == 0 ? answers({true, true, true}) : answers({false});
  EXPECT_TRUE(stairs->is_done()) << "turned eight times";
}

TEST(Staircase, HoversWhere79PercentAreRight) {
  const int trials = 20'000;
  const Psychometric truth{15.0, 4.0, 0.0};
  auto settings = RuleSettings{.name = "staircase", .trials = trials, .reversals = 1 << 20};
  const auto stairs = make_rule(settings);
  std::mt19937_64 engine(5);
  double right = 0.0;
  while (!stairs->is_done()) {
    const bool is_right = draw(engine) < truth.probability(stairs->difference());
    right += is_right ? 1.0 : 0.0;
    stairs->take(is_right);
  }
  // 0.794 for small steps; steps of the root of 2 hover a little off, and the error of the count is 0.003.
  EXPECT_NEAR(right / trials, std::cbrt(0.5), 0.02);
}

TEST(Quest, ClosesInOnTheThreshold) {
  const Psychometric truth{12.0, 3.5, 0.02};
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const auto quest = rule("quest", 400);
    std::mt19937_64 engine(seed);
    while (!quest->is_done()) quest->take(draw(engine) < truth.probability(quest->difference()));
    // Where 82% are right a trial has 0.94 of information on ln threshold: 0.051 is the error after 400.
    EXPECT_NEAR(std::log(*quest->estimate() / truth.threshold), 0.0, 3 * 0.051);
  }
}

TEST(Rule, StaysBetweenItsBounds) {
  for (const std::string_view name : kRuleNames) {
    for (const bool right : {true, false}) {
      const auto one = make_rule({.name = std::string(name), .least = 2.0, .most = 80.0, .steps = 40});
      while (!one->is_done()) {
        EXPECT_GE(one->difference(), 2.0) << name;
        EXPECT_LE(one->difference(), 80.0) << name;
        one->take(right);
      }
      EXPECT_EQ(one->difference(), right ? 2.0 : 80.0) << name;
    }
  }
}

}  // namespace
}  // namespace rhexis::studies
