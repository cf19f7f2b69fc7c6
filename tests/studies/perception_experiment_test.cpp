#include "studies/perception_experiment.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "base/parallel.h"
#include "studies/perception_analysis.h"
#include "studies/simulated_observer.h"

namespace rhexis::studies {
namespace {

PerceptionSettings thesis() { return *read_perception({}); }

std::vector<Trial> trials_of(const PerceptionSettings& settings, std::uint64_t seed) {
  std::vector<Trial> out;
  for (const AnsweredTrial& one : observe(settings, {15.0, 4.0, 0.02}, seed)) out.push_back(one.trial);
  return out;
}

TEST(PerceptionExperiment, IsThatOfTheThesis) {
  const std::vector<Trial> trials = trials_of(thesis(), 1);
  ASSERT_EQ(trials.size(), 60U) << "two points, three directions, twice, five steps";
  std::map<std::pair<std::size_t, std::size_t>, std::set<std::size_t>> runs;
  for (std::size_t k = 0; k < trials.size(); ++k) {
    EXPECT_EQ(trials[k].number, static_cast<int>(k) + 1);
    EXPECT_EQ(trials[k].run, trials[k - k % 5].run) << "one run after the other";
    if (k % 5 == 0) {
      EXPECT_EQ(trials[k].difference, 45.0);
    }
    runs[{trials[k].point, trials[k].direction}].insert(trials[k].run);
  }
  EXPECT_EQ(runs.size(), 6U);
  for (const auto& [where, of] : runs) EXPECT_EQ(of.size(), 2U);
}

TEST(PerceptionExperiment, IsDecidedByItsSeedAndTheAnswers) {
  EXPECT_EQ(trials_of(thesis(), 7), trials_of(thesis(), 7));
  EXPECT_NE(trials_of(thesis(), 7), trials_of(thesis(), 8));
  PerceptionExperiment one(thesis(), 7), two(thesis(), 7);
  one.answer(Side::a);
  two.answer(Side::b);
  EXPECT_NE(one.current()->difference, two.current()->difference) << "one of the two was right";
}

TEST(PerceptionExperiment, PutsTheSampleOnEitherSideByChance) {
  int a = 0;
  const int seeds = 50;
  for (std::uint64_t seed = 0; seed < seeds; ++seed)
    for (const Trial& trial : trials_of(thesis(), seed)) a += trial.same == Side::a ? 1 : 0;
  EXPECT_NEAR(a, 30.0 * seeds, 4.0 * std::sqrt(60.0 * seeds / 4.0));
}

TEST(PerceptionExperiment, InterleavesRuns) {
  PerceptionSettings settings = thesis();
  settings.interleaved = true;
  const std::vector<Trial> trials = trials_of(settings, 1);
  ASSERT_EQ(trials.size(), 60U);
  int changes = 0;
  std::map<std::size_t, int> of_run;
  for (std::size_t k = 0; k < trials.size(); ++k) {
    changes += k > 0 && trials[k].run != trials[k - 1].run ? 1 : 0;
    ++of_run[trials[k].run];
  }
  EXPECT_GT(changes, 30);
  for (const auto& [run, count] : of_run) EXPECT_EQ(count, 5);
}

/// A fixed seed, and an interval that misses the truth in 3 of 1000 cases.
TEST(SimulatedObserver, IsFoundOutByEachRule) {
  for (const std::string_view rule : kRuleNames) {
    for (const double threshold : {8.0, 15.0, 30.0}) {
      PerceptionSettings settings = thesis();
      settings.rule.name = rule;
      settings.rule.trials = 60;
      settings.repeats = rule == kRuleNames[0] ? 30 : 10;  // of five trials each, and of some forty
      const std::vector<AnsweredTrial> answered = observe(settings, {threshold, 4.0, 0.02}, 11);
      const auto fit = fit_psychometric(counts_of(answered), 0.997);
      ASSERT_TRUE(fit && fit->low && fit->high) << rule << threshold;
      EXPECT_LT(*fit->low, threshold) << rule;
      EXPECT_GT(*fit->high, threshold) << rule;
      EXPECT_LT(*fit->high / *fit->low, 2.0) << rule << ": hundreds of trials say more than nothing";
    }
  }
}

/// An adaptive rule asks where the answers lead it, so that its intervals hold a little less than answers at fixed
/// differences do (psychometric_test): 91% of 200.
TEST(SimulatedObserver, IntervalsHoldTheThreshold) {
  const int observers = 100;
  PerceptionSettings settings = thesis();
  settings.rule.name = "quest";
  settings.repeats = 1;
  const RuleTrial found = try_rule(settings, {15.0, 4.0, 0.02}, observers, 1);
  EXPECT_GT(found.bounded, 0.99);
  EXPECT_GT(found.held, 0.93 - 3.0 * std::sqrt(0.93 * 0.07 / observers));
  EXPECT_NEAR(found.bias, 0.0, 3.0 * found.spread / std::sqrt(observers) + 0.02) << "of a likelihood's own small bias";
}

TEST(SimulatedObserver, IsTheSameOnAnyNumberOfThreads) {
  std::vector<RuleTrial> found;
  const int before = thread_count();
  for (const int threads : {1, 3}) {
    set_thread_count(threads);
    found.push_back(try_rule(thesis(), {15.0, 4.0, 0.02}, 8, 3));
  }
  set_thread_count(before);
  EXPECT_EQ(found[0].estimate, found[1].estimate);
  EXPECT_EQ(found[0].spread, found[1].spread);
}

TEST(SimulatedObserver, WhoFeelsNothingIsNotToldApart) {
  int told = 0;
  const int seeds = 40;
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const std::vector<AnsweredTrial> answered = observe(thesis(), {1e9, 4.0, 0.0}, seed);
    for (const DifferenceClass& one : classify(counts_of(answered), thesis().classes)) told += one.is_told() ? 1 : 0;
  }
  // Five classes at 5% at most each, but for what an adaptive rule makes of chance.
  EXPECT_LE(told, 0.05 * 5 * seeds + 3.0 * std::sqrt(0.05 * 5 * seeds));
}

}  // namespace
}  // namespace rhexis::studies
