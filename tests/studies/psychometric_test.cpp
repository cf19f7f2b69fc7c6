#include "studies/psychometric.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "studies/perception_experiment.h"

namespace rhexis::studies {
namespace {

const std::vector<double> kDifferences{1.4, 2.8, 5.6, 11.25, 22.5, 33.75, 45.0, 67.5};

std::vector<AnswerCount> expected_answers(const Psychometric& truth, int trials) {
  std::vector<AnswerCount> out;
  for (const double difference : kDifferences)
    out.push_back({difference, trials, static_cast<int>(std::lround(trials * truth.probability(difference)))});
  return out;
}

TEST(Psychometric, GoesFromGuessingToLapses) {
  const Psychometric function{15.0, 3.0, 0.04};
  EXPECT_NEAR(function.probability(1e-6), 0.5, 1e-15);
  EXPECT_NEAR(function.probability(15.0), 0.5 + 0.46 / 2.0, 1e-15);
  EXPECT_NEAR(function.probability(1e6), 0.96, 1e-13);
  EXPECT_DOUBLE_EQ((Psychometric{15.0, 3.0, 0.0}.probability(15.0)), 0.75);
  const double h = 1e-5;  // central difference: h^2 times a third derivative of order 1
  const double slope =
      (function.probability(15.0 * std::exp(h)) - function.probability(15.0 * std::exp(-h))) / (2.0 * h);
  EXPECT_NEAR(slope, 0.46 * 3.0 / 4.0, 1e-9);
}

TEST(PsychometricFit, FindsTheFunctionOfManyAnswers) {
  // Counts are rounded to 1e-6 of a million trials, and the parameters follow by less than a hundred times that.
  for (const Psychometric truth :
       {Psychometric{6.0, 2.5, 0.0}, Psychometric{15.0, 4.0, 0.02}, Psychometric{30.0, 6.0, 0.05}}) {
    const auto fit = fit_psychometric(expected_answers(truth, 1'000'000));
    ASSERT_TRUE(fit.has_value());
    EXPECT_NEAR(fit->function.threshold, truth.threshold, 1e-4 * truth.threshold);
    EXPECT_NEAR(fit->function.slope, truth.slope, 1e-3 * truth.slope);
    EXPECT_NEAR(fit->function.lapse, truth.lapse, 1e-4);
    ASSERT_TRUE(fit->low && fit->high);
    EXPECT_LT(*fit->low, truth.threshold);
    EXPECT_GT(*fit->high, truth.threshold);
    EXPECT_LT(*fit->high / *fit->low, 1.02);
  }
}

/// The slow, obvious profile: a grid over slope and lapse.
double grid_profile(double threshold, const std::vector<AnswerCount>& answers) {
  double best = -std::numeric_limits<double>::infinity();
  for (int i = 0; i <= 400; ++i) {
    const double slope = kLeastSlope * std::pow(kMostSlope / kLeastSlope, i / 400.0);
    for (int k = 0; k <= 60; ++k)
      best = std::max(best, log_likelihood({threshold, slope, kMostLapse * k / 60.0}, answers));
  }
  return best;
}

TEST(PsychometricFit, IsTheHighestPointAndItsIntervalEndsWhereTheProfileHasFallenByHalfAQuantile) {
  const std::vector<AnswerCount> answers{{5.6, 12, 5}, {11.25, 14, 9}, {22.5, 20, 15}, {45.0, 12, 12}, {67.5, 3, 2}};
  const auto fit = fit_psychometric(answers);
  ASSERT_TRUE(fit && fit->low && fit->high);
  EXPECT_NEAR(fit->log_likelihood, log_likelihood(fit->function, answers), 1e-12);
  double highest = -1e300;
  for (int i = 0; i <= 300; ++i) highest = std::max(highest, grid_profile(2.0 * std::pow(40.0, i / 300.0), answers));
  EXPECT_GE(fit->log_likelihood, highest);
  EXPECT_NEAR(fit->log_likelihood, highest, 1e-3);  // of the grid's cells, squared
  for (const double end : {*fit->low, *fit->high})
    EXPECT_NEAR(fit->log_likelihood - grid_profile(end, answers), 0.5 * 3.841458820694124, 1e-3);
}

TEST(PsychometricFit, ItsIntervalHoldsTheThresholdAsOftenAsItSays) {
  const Psychometric truth{15.0, 4.0, 0.02};
  const int sets = 300;
  int held = 0;
  std::mt19937_64 engine(17);
  for (int set = 0; set < sets; ++set) {
    std::vector<AnswerCount> answers;
    for (const double difference : kDifferences) {
      AnswerCount count{difference, 40, 0};
      for (int k = 0; k < count.trials; ++k) count.right += draw(engine) < truth.probability(difference) ? 1 : 0;
      answers.push_back(count);
    }
    const auto fit = fit_psychometric(answers);
    ASSERT_TRUE(fit.has_value());
    held += (!fit->low || *fit->low <= truth.threshold) && (!fit->high || *fit->high >= truth.threshold) ? 1 : 0;
  }
  EXPECT_NEAR(held, 0.95 * sets, 3.0 * std::sqrt(0.95 * 0.05 * sets));
}

TEST(PsychometricFit, SaysWhenAnswersBoundNothing) {
  std::vector<AnswerCount> all_right, half_right;
  for (const double difference : kDifferences) {
    all_right.push_back({difference, 10, 10});
    half_right.push_back({difference, 10, 5});
  }
  EXPECT_FALSE(fit_psychometric(all_right).has_value());
  EXPECT_FALSE(fit_psychometric(half_right).has_value());
  EXPECT_FALSE(fit_psychometric({}).has_value());
}

}  // namespace
}  // namespace rhexis::studies
