#pragma once

/// A two-alternative forced choice between crack angles, as a function of what was answered: no clock, no file, no body
/// (5.2.3 of the thesis). Each trial has a sample and two models A and B, one like the sample and one whose crack runs
/// another way; the question is which is like it.

#include <cstdint>
#include <memory>
#include <random>
#include <vector>

#include "studies/perception_rule.h"
#include "studies/perception_settings.h"
#include "studies/psychometric.h"

namespace rhexis::studies {

enum class Side { a, b };
[[nodiscard]] constexpr Side other(Side side) { return side == Side::a ? Side::b : Side::a; }
[[nodiscard]] constexpr char letter_of(Side side) { return side == Side::a ? 'A' : 'B'; }

struct Trial {
  int number = 0;       ///< from 1
  std::size_t run = 0;  ///< from 0; a point and a direction have `repeats` of them
  std::size_t point = 0;
  std::size_t direction = 0;
  double difference = 0.0;  ///< degrees, by which the odd one's crack falls short of the sample's angle
  Side same = Side::a;      ///< which is like the sample

  [[nodiscard]] bool operator==(const Trial&) const = default;
};

struct AnsweredTrial {
  Trial trial;
  Side answer = Side::a;
  [[nodiscard]] bool is_right() const { return answer == trial.same; }
};

/// In [0, 1): the same from the same engine everywhere, which the distributions of the standard library are not.
[[nodiscard]] double draw(std::mt19937_64& engine);

class PerceptionExperiment {
 public:
  /// `settings` has points and directions. The same seed and answers: the same trials.
  PerceptionExperiment(const PerceptionSettings& settings, std::uint64_t seed);

  /// nullptr: all is answered.
  [[nodiscard]] const Trial* current() const { return is_done_ ? nullptr : &trial_; }
  /// To the current trial, which has to be there.
  void answer(Side side);
  [[nodiscard]] const std::vector<AnsweredTrial>& answered() const { return answered_; }
  /// Runs that are done, of all.
  [[nodiscard]] std::size_t runs_done() const { return runs_.size() - open_.size(); }
  [[nodiscard]] std::size_t runs() const { return runs_.size(); }
  /// Of a run, as its rule has it.
  [[nodiscard]] std::optional<double> estimate(std::size_t run) const { return runs_[run].rule->estimate(); }

 private:
  struct Run {
    std::size_t point = 0;
    std::size_t direction = 0;
    std::unique_ptr<Rule> rule;
  };
  void next();

  bool interleaved_;
  std::mt19937_64 engine_;
  std::vector<Run> runs_;
  std::vector<std::size_t> open_;  ///< runs that are not done, the next first
  std::size_t now_ = 0;            ///< place in open_ of the current trial's run
  Trial trial_;
  bool is_done_ = false;
  std::vector<AnsweredTrial> answered_;
};

/// Answers by their difference, ascending.
[[nodiscard]] std::vector<AnswerCount> counts_of(const std::vector<AnsweredTrial>& answered);

}  // namespace rhexis::studies
