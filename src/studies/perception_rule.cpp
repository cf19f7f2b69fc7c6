#include "studies/perception_rule.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/check.h"
#include "studies/psychometric.h"

namespace rhexis::studies {
namespace {

class Halving final : public Rule {
 public:
  explicit Halving(const RuleSettings& settings) : settings_(settings), difference_(settings.start) {}
  [[nodiscard]] double difference() const override { return difference_; }
  [[nodiscard]] bool is_done() const override { return taken_ >= settings_.steps; }
  void take(bool right) override {
    ++taken_;
    difference_ = std::clamp((right ? 0.5 : 1.5) * difference_, settings_.least, settings_.most);
  }
  [[nodiscard]] std::optional<double> estimate() const override { return std::nullopt; }

 private:
  RuleSettings settings_;
  double difference_;
  int taken_ = 0;
};

class Staircase final : public Rule {
 public:
  static constexpr int kRightInARow = 3;
  static constexpr double kFirstFactor = 2.0;
  static constexpr std::size_t kLeftOut = 2;  ///< reversals that still bring it near the threshold

  explicit Staircase(const RuleSettings& settings) : settings_(settings), difference_(settings.start) {}
  [[nodiscard]] double difference() const override { return difference_; }
  [[nodiscard]] bool is_done() const override {
    return taken_ >= settings_.trials || turned_at_.size() >= static_cast<std::size_t>(settings_.reversals);
  }
  void take(bool right) override {
    ++taken_;
    right_in_a_row_ = right ? right_in_a_row_ + 1 : 0;
    if (right && right_in_a_row_ < kRightInARow) return;
    right_in_a_row_ = 0;
    const int way = right ? -1 : 1;
    if (last_way_ != 0 && way != last_way_) turned_at_.push_back(difference_);
    last_way_ = way;
    const double factor = turned_at_.empty() ? kFirstFactor : std::sqrt(kFirstFactor);
    difference_ = std::clamp(way > 0 ? difference_ * factor : difference_ / factor, settings_.least, settings_.most);
  }
  [[nodiscard]] std::optional<double> estimate() const override {
    if (turned_at_.size() <= kLeftOut) return std::nullopt;
    double sum = 0.0;
    for (std::size_t k = kLeftOut; k < turned_at_.size(); ++k) sum += std::log(turned_at_[k]);
    return std::exp(sum / static_cast<double>(turned_at_.size() - kLeftOut));
  }

 private:
  RuleSettings settings_;
  double difference_;
  int taken_ = 0;
  int right_in_a_row_ = 0;
  int last_way_ = 0;
  std::vector<double> turned_at_;
};

class Quest final : public Rule {
 public:
  static constexpr double kSpread = 1.0;      ///< of ln threshold, before anything is known: a factor of e
  static constexpr double kSlope = 3.5;       ///< assumed, as the paper does
  static constexpr double kLapse = 0.02;      ///< assumed: one answer by mistake is not to settle all
  static constexpr double kPlacement = 0.82;  ///< part of right answers where differences are placed
  static constexpr double kCell = 0.02;       ///< of ln threshold

  explicit Quest(const RuleSettings& settings) : settings_(settings) {
    const double middle = std::log(settings.start);
    const double low = std::log(kLeastThreshold);
    const auto cells = static_cast<std::size_t>((std::log(kMostThreshold) - low) / kCell);
    for (std::size_t k = 0; k <= cells; ++k) {
      at_.push_back(low + kCell * static_cast<double>(k));
      const double off = (at_.back() - middle) / kSpread;
      ln_posterior_.push_back(-0.5 * off * off);
    }
  }
  [[nodiscard]] double difference() const override {
    const double core = (kPlacement - kGuess) / (1.0 - kGuess - kLapse);
    const double above = std::pow(core / (1.0 - core), 1.0 / kSlope);  // where F is `core`, over the threshold
    return std::clamp(mean() * above, settings_.least, settings_.most);
  }
  [[nodiscard]] bool is_done() const override { return taken_ >= settings_.trials; }
  void take(bool right) override {
    ++taken_;
    const double shown = difference();
    for (std::size_t k = 0; k < at_.size(); ++k) {
      const double p = Psychometric{std::exp(at_[k]), kSlope, kLapse}.probability(shown);
      ln_posterior_[k] += std::log(right ? p : 1.0 - p);
    }
  }
  [[nodiscard]] std::optional<double> estimate() const override { return mean(); }

 private:
  /// degrees: of the posterior of ln threshold, which King-Smith et al. (1994) found better than its highest.
  [[nodiscard]] double mean() const {
    const double most = *std::max_element(ln_posterior_.begin(), ln_posterior_.end());
    double weight = 0.0;
    double sum = 0.0;
    for (std::size_t k = 0; k < at_.size(); ++k) {
      const double w = std::exp(ln_posterior_[k] - most);
      weight += w;
      sum += w * at_[k];
    }
    return std::exp(sum / weight);
  }

  RuleSettings settings_;
  std::vector<double> at_;  ///< ln degrees
  std::vector<double> ln_posterior_;
  int taken_ = 0;
};

}  // namespace

std::unique_ptr<Rule> make_rule(const RuleSettings& settings) {
  RHEXIS_CHECK(0.0 < settings.least && settings.least <= settings.start && settings.start <= settings.most,
               "differences from {} to {}, first {}", settings.least, settings.most, settings.start);
  if (settings.name == kRuleNames[1]) return std::make_unique<Staircase>(settings);
  if (settings.name == kRuleNames[2]) return std::make_unique<Quest>(settings);
  RHEXIS_CHECK(settings.name == kRuleNames[0], "rule '{}'", settings.name);
  return std::make_unique<Halving>(settings);
}

}  // namespace rhexis::studies
