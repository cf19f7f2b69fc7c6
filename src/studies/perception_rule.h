#pragma once

/// Which difference is shown next: the rules of adaptive experiments, each for one run of trials. A rule sees whether
/// answers are right, and nothing else.

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace rhexis::studies {

/// halving: (5.1) and (5.2) of the thesis. After a right answer half the difference, after a wrong one half as much
/// again. staircase: transformed up and down (Levitt, 1971): down after three right answers in a row, up after a wrong
/// one, so that it hovers where 79% are right; by a factor of 2 until it first turns, then by its square root. quest:
/// Watson and Pelli (1983): each difference is the one where 82% would be right by all that was answered so far.
inline constexpr std::array<std::string_view, 3> kRuleNames{"halving", "staircase", "quest"};

struct RuleSettings {
  std::string name{kRuleNames[0]};
  double start = 45.0;  ///< degrees, the first difference; for quest what it expects beforehand
  double least = 1.0;   ///< degrees: no smaller difference is shown,
  double most = 89.0;   ///< and no larger one
  int steps = 5;        ///< trials of a run of halving
  int trials = 40;      ///< of quest; the most of a staircase,
  int reversals = 8;    ///< which ends before, when it has turned so often
};

class Rule {
 public:
  virtual ~Rule() = default;
  /// degrees, in [least, most].
  [[nodiscard]] virtual double difference() const = 0;
  [[nodiscard]] virtual bool is_done() const = 0;
  /// The answer to difference(). Not when it is done.
  virtual void take(bool right) = 0;
  /// degrees, what the rule itself takes for the threshold: where 75% are right for quest, where 79% are for a
  /// staircase, once it has turned three times. Empty: it says nothing.
  [[nodiscard]] virtual std::optional<double> estimate() const = 0;
};

/// `settings.name` is one of kRuleNames; 0 < least <= start <= most.
[[nodiscard]] std::unique_ptr<Rule> make_rule(const RuleSettings& settings);

}  // namespace rhexis::studies
