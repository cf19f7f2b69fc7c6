#pragma once

/// The verdict on answers in classes of differences, as Table 5.4 of the thesis has it: which are right more often than
/// guessing explains.

#include <optional>
#include <span>
#include <vector>

#include "studies/psychometric.h"

namespace rhexis::studies {

/// Of a test: the chance that guessing alone passes it.
inline constexpr double kSignificance = 0.05;

/// The least number of right answers of `trials` that guessing reaches with a chance of `significance` at most, exactly
/// (binomial, one-sided); trials + 1: even all of them would not do.
[[nodiscard]] int critical_value(int trials, double significance = kSignificance);

struct DifferenceClass {
  double from = 0.0;         ///< degrees
  std::optional<double> to;  ///< degrees, beyond the class; empty: no end
  int trials = 0;
  int right = 0;
  [[nodiscard]] int critical() const { return critical_value(trials); }
  [[nodiscard]] bool is_told() const { return right >= critical(); }
};

/// `begins`: degrees, ascending, the first 0.
[[nodiscard]] std::vector<DifferenceClass> classify(std::span<const AnswerCount> answers,
                                                    std::span<const double> begins);

/// degrees: where the first class begins from which on every class with trials is told. Empty: none.
[[nodiscard]] std::optional<double> told_from(std::span<const DifferenceClass> classes);

/// Table 5.4 of the thesis, in its classes.
[[nodiscard]] std::vector<DifferenceClass> thesis_classes();
/// The same as answers at one difference each, for a fit: the middle of its class, and 67.5 degrees for the last, which
/// is where (5.2) leads from 45.
[[nodiscard]] std::vector<AnswerCount> thesis_answers();

}  // namespace rhexis::studies
