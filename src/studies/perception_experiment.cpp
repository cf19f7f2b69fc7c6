#include "studies/perception_experiment.h"

#include <algorithm>
#include <map>

#include "base/check.h"

namespace rhexis::studies {
namespace {

/// In [0, count).
std::size_t pick(std::mt19937_64& engine, std::size_t count) {
  return static_cast<std::size_t>(draw(engine) * static_cast<double>(count));
}

}  // namespace

double draw(std::mt19937_64& engine) { return static_cast<double>(engine() >> 11U) * 0x1p-53; }

PerceptionExperiment::PerceptionExperiment(const PerceptionSettings& settings, std::uint64_t seed)
    : interleaved_(settings.interleaved), engine_(seed) {
  RHEXIS_CHECK(settings.runs() > 0, "no run");
  for (std::size_t point = 0; point < settings.points.size(); ++point)
    for (std::size_t direction = 0; direction < settings.directions.size(); ++direction)
      for (int repeat = 0; repeat < settings.repeats; ++repeat)
        runs_.push_back({point, direction, make_rule(settings.rule)});
  for (std::size_t run = 0; run < runs_.size(); ++run) open_.push_back(run);
  for (std::size_t left = open_.size(); left > 1; --left) std::swap(open_[left - 1], open_[pick(engine_, left)]);
  next();
}

void PerceptionExperiment::answer(Side side) {
  RHEXIS_CHECK(!is_done_, "all {} trials are answered", answered_.size());
  answered_.push_back({trial_, side});
  Rule& rule = *runs_[trial_.run].rule;
  rule.take(answered_.back().is_right());
  if (rule.is_done()) open_.erase(open_.begin() + static_cast<std::ptrdiff_t>(now_));
  next();
}

void PerceptionExperiment::next() {
  is_done_ = open_.empty();
  if (is_done_) return;
  now_ = interleaved_ ? pick(engine_, open_.size()) : 0;
  const Run& run = runs_[open_[now_]];
  trial_ = {.number = static_cast<int>(answered_.size()) + 1,
            .run = open_[now_],
            .point = run.point,
            .direction = run.direction,
            .difference = run.rule->difference(),
            .same = draw(engine_) < 0.5 ? Side::a : Side::b};
}

std::vector<AnswerCount> counts_of(const std::vector<AnsweredTrial>& answered) {
  std::map<double, AnswerCount> counts;
  for (const AnsweredTrial& one : answered) {
    AnswerCount& count = counts[one.trial.difference];
    count.difference = one.trial.difference;
    ++count.trials;
    count.right += one.is_right() ? 1 : 0;
  }
  std::vector<AnswerCount> out;
  for (const auto& [difference, count] : counts) out.push_back(count);
  return out;
}

}  // namespace rhexis::studies
