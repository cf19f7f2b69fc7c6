#include "studies/perception_analysis.h"

#include <algorithm>

#include <fmt/format.h>
#include <boost/math/distributions/binomial.hpp>

#include "base/check.h"
#include "studies/published.h"

namespace rhexis::studies {
namespace {

constexpr double kThesisBegins[] = {0.0, 15.0, 30.0, 45.0, 60.0};

}  // namespace

int critical_value(int trials, double significance) {
  RHEXIS_CHECK(trials >= 0 && significance > 0.0 && significance < 1.0, "{} trials at {}", trials, significance);
  if (trials == 0) return 1;
  const boost::math::binomial guessing(trials, kGuess);
  const auto chance_of = [&](int right) {  // of so many, or more
    return right <= 0 ? 1.0 : right > trials ? 0.0 : boost::math::cdf(boost::math::complement(guessing, right - 1));
  };
  // The quantile is of a distribution that jumps: how it rounds is settled by the chances themselves.
  int right = static_cast<int>(boost::math::quantile(boost::math::complement(guessing, significance)));
  while (chance_of(right) > significance) ++right;
  while (right > 0 && chance_of(right - 1) <= significance) --right;
  return right;
}

std::vector<DifferenceClass> classify(std::span<const AnswerCount> answers, std::span<const double> begins) {
  std::vector<DifferenceClass> out;
  for (std::size_t k = 0; k < begins.size(); ++k) {
    DifferenceClass one{.from = begins[k], .to = std::nullopt};
    if (k + 1 < begins.size()) one.to = begins[k + 1];
    for (const AnswerCount& count : answers) {
      if (count.difference < one.from || (one.to && count.difference >= *one.to)) continue;
      one.trials += count.trials;
      one.right += count.right;
    }
    out.push_back(one);
  }
  return out;
}

std::optional<double> told_from(std::span<const DifferenceClass> classes) {
  std::optional<double> from;
  for (auto one = classes.rbegin(); one != classes.rend(); ++one) {
    if (one->trials == 0) continue;
    if (!one->is_told()) break;
    from = one->from;
  }
  return from;
}

std::vector<DifferenceClass> thesis_classes() {
  std::vector<DifferenceClass> classes = classify({}, kThesisBegins);
  for (std::size_t k = 0; k < classes.size(); ++k) {
    classes[k].trials = static_cast<int>(published_value(fmt::format("angle-perception.trials.{}", k + 1)));
    classes[k].right = static_cast<int>(published_value(fmt::format("angle-perception.right.{}", k + 1)));
  }
  return classes;
}

std::vector<AnswerCount> thesis_answers() {
  constexpr double kBeyond = 67.5;
  std::vector<AnswerCount> out;
  for (const DifferenceClass& one : thesis_classes())
    out.push_back({one.to ? 0.5 * (one.from + *one.to) : kBeyond, one.trials, one.right});
  return out;
}

}  // namespace rhexis::studies
