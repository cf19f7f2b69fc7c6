#pragma once

/// How often an observer answers right in a two-alternative forced choice, over the difference that there is to feel,
/// and what answers say of that.

#include <optional>
#include <span>

namespace rhexis::studies {

/// Right answers of who feels nothing.
inline constexpr double kGuess = 0.5;

/// P(x) = guess + (1 - guess - lapse) F(x), F the logistic function of ln x: F(0) = 0, and F(threshold) = 1/2, so that
/// without lapses three of four answers at the threshold are right.
struct Psychometric {
  double threshold = 15.0;  ///< degrees
  double slope = 4.0;       ///< dF/d(ln x) = slope / 4 at the threshold
  double lapse = 0.0;       ///< part of the answers that are wrong however large the difference

  /// `difference` > 0, degrees.
  [[nodiscard]] double probability(double difference) const;
};

/// Answers at one difference.
struct AnswerCount {
  double difference = 0.0;  ///< degrees, > 0
  int trials = 0;
  int right = 0;
};

/// Where a fit looks: thresholds in degrees, slopes, lapses. A lapse beyond 6% is no lapse (Wichmann and Hill, 2001).
inline constexpr double kLeastThreshold = 0.1, kMostThreshold = 720.0;
inline constexpr double kLeastSlope = 0.5, kMostSlope = 20.0;
inline constexpr double kMostLapse = 0.06;

struct PsychometricFit {
  Psychometric function;  ///< of the largest likelihood
  double log_likelihood = 0.0;
  /// degrees: ends of the interval of the threshold by its profile likelihood; empty: the answers bound it not.
  std::optional<double> low, high;
};

/// Largest likelihood over threshold, slope and lapse; the interval holds every threshold whose profile log-likelihood
/// is within half a quantile of chi-squared with one degree of freedom of it. Empty where the likelihood has no maximum
/// inside the range: all right, no better than chance.
[[nodiscard]] std::optional<PsychometricFit> fit_psychometric(std::span<const AnswerCount> answers,
                                                              double confidence = 0.95);

/// ln of the probability of these answers, without the binomial coefficients.
[[nodiscard]] double log_likelihood(const Psychometric& function, std::span<const AnswerCount> answers);

}  // namespace rhexis::studies
