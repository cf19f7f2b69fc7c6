#include "studies/psychometric.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/tools/minima.hpp>
#include <boost/math/tools/roots.hpp>

#include "base/check.h"

namespace rhexis::studies {
namespace {

/// Bits of an argument where a parabola's top is sought: half of those of a double show in its value.
constexpr int kBits = 26;
/// Cells of the scan that finds the highest of several tops, of ln threshold (0.1 each) and ln slope.
constexpr int kThresholdCells = 89;
constexpr int kSlopeCells = 10;

/// Of a log-likelihood, a sum of some hundred terms: two that differ by less than this part are the same.
constexpr double kRounding = 1e-12;

struct Top {
  double at = 0.0;
  double value = -std::numeric_limits<double>::infinity();
};

/// The highest of `function` on [low, high]: of the ends of `cells` cells, and then between its neighbours.
template <class Function>
Top highest(const Function& function, double low, double high, int cells) {
  const double width = (high - low) / cells;
  Top best;
  for (int k = 0; k <= cells; ++k) {
    const double at = low + width * k;
    if (const double value = function(at); value > best.value) best = {at, value};
  }
  const auto [at, value] = boost::math::tools::brent_find_minima(
      [&](double x) { return -function(x); }, std::max(low, best.at - width), std::min(high, best.at + width), kBits);
  return -value > best.value ? Top{at, -value} : best;
}

class Likelihood {
 public:
  explicit Likelihood(std::span<const AnswerCount> answers) : answers_(answers), core_(answers.size()) {}

  struct Profile {
    double slope = 0.0, lapse = 0.0, value = 0.0;
  };
  /// Over slope and lapse.
  Profile profile(double ln_threshold) {
    const auto at_slope = [&](double ln_slope) { return best_lapse(ln_threshold, ln_slope).second; };
    const Top top = highest(at_slope, std::log(kLeastSlope), std::log(kMostSlope), kSlopeCells);
    return {std::exp(top.at), best_lapse(ln_threshold, top.at).first, top.value};
  }

 private:
  /// ln P is concave in the lapse: its derivative falls, and has one root at most.
  std::pair<double, double> best_lapse(double ln_threshold, double ln_slope) {
    const Psychometric sharp{std::exp(ln_threshold), std::exp(ln_slope), 0.0};
    for (std::size_t k = 0; k < answers_.size(); ++k)
      core_[k] = (sharp.probability(answers_[k].difference) - kGuess) / (1.0 - kGuess);
    const auto derivative = [&](double lapse) {
      double sum = 0.0;
      for (std::size_t k = 0; k < answers_.size(); ++k) {
        const double p = kGuess + (1.0 - kGuess - lapse) * core_[k];
        const double wrong = answers_[k].trials - answers_[k].right;
        if (wrong > 0.0 && p >= 1.0) return std::numeric_limits<double>::infinity();
        sum += core_[k] * ((wrong > 0.0 ? wrong / (1.0 - p) : 0.0) - answers_[k].right / p);
      }
      return sum;
    };
    double lapse = 0.0;
    if (derivative(0.0) > 0.0) {
      lapse = kMostLapse;
      if (derivative(kMostLapse) < 0.0) {
        const auto [low, high] =
            boost::math::tools::bisect(derivative, 0.0, kMostLapse, boost::math::tools::eps_tolerance<double>(kBits));
        lapse = 0.5 * (low + high);
      }
    }
    return {lapse, log_likelihood({sharp.threshold, sharp.slope, lapse}, answers_)};
  }

  std::span<const AnswerCount> answers_;
  std::vector<double> core_;  ///< F of each
};

/// Where the profile falls below `floor` between `inside` and the end of the range; empty: nowhere.
std::optional<double> end_of_interval(Likelihood& likelihood, double inside, double end, double floor) {
  const auto over = [&](double ln_threshold) { return likelihood.profile(ln_threshold).value - floor; };
  const double step = (end > inside ? 1.0 : -1.0) * 0.2;
  for (double at = inside; at != end;) {
    const double next = std::abs(end - at) <= std::abs(step) ? end : at + step;
    if (over(next) < 0.0) {
      std::uintmax_t most = 60;
      const auto [low, high] = boost::math::tools::toms748_solve(over, std::min(at, next), std::max(at, next),
                                                                 boost::math::tools::eps_tolerance<double>(20), most);
      return std::exp(0.5 * (low + high));
    }
    at = next;
  }
  return std::nullopt;
}

}  // namespace

double Psychometric::probability(double difference) const {
  return kGuess + (1.0 - kGuess - lapse) / (1.0 + std::pow(threshold / difference, slope));
}

double log_likelihood(const Psychometric& function, std::span<const AnswerCount> answers) {
  double sum = 0.0;
  for (const AnswerCount& count : answers) {
    const double p = function.probability(count.difference);
    const int wrong = count.trials - count.right;
    if (count.right > 0) sum += count.right * std::log(p);
    if (wrong > 0) sum += wrong * std::log(1.0 - p);
  }
  return sum;
}

std::optional<PsychometricFit> fit_psychometric(std::span<const AnswerCount> answers, double confidence) {
  for (const AnswerCount& count : answers)
    RHEXIS_CHECK(count.difference > 0.0 && count.right >= 0 && count.right <= count.trials, "{} of {} right at {}",
                 count.right, count.trials, count.difference);
  const double low = std::log(kLeastThreshold);
  const double high = std::log(kMostThreshold);
  Likelihood likelihood(answers);
  const auto at_threshold = [&](double ln_threshold) { return likelihood.profile(ln_threshold).value; };
  const Top top = highest(at_threshold, low, high, kThresholdCells);
  // At the ends of the range all answers are sure, or all are guessed: what does no better has no maximum to speak of.
  const double ends = std::max(at_threshold(low), at_threshold(high));
  if (!std::isfinite(top.value) || top.value - ends <= kRounding * std::abs(ends)) return std::nullopt;
  const Likelihood::Profile best = likelihood.profile(top.at);
  const boost::math::chi_squared one_degree(1.0);
  const double floor = top.value - 0.5 * boost::math::quantile(one_degree, confidence);
  PsychometricFit fit;
  fit.function = {std::exp(top.at), best.slope, best.lapse};
  fit.log_likelihood = top.value;
  fit.low = end_of_interval(likelihood, top.at, low, floor);
  fit.high = end_of_interval(likelihood, top.at, high, floor);
  return fit;
}

}  // namespace rhexis::studies
