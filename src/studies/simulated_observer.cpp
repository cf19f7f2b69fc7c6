#include "studies/simulated_observer.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/parallel.h"

namespace rhexis::studies {
namespace {

/// Between the streams of an experiment and of its observer.
constexpr std::uint64_t kOtherStream = 0x9e3779b97f4a7c15ULL;

void answer_all(PerceptionExperiment& experiment, const Psychometric& truth, std::uint64_t seed) {
  std::mt19937_64 engine(seed ^ kOtherStream);
  while (const Trial* trial = experiment.current()) {
    const bool is_right = draw(engine) < truth.probability(trial->difference);
    experiment.answer(is_right ? trial->same : other(trial->same));
  }
}

struct Seen {
  double trials = 0.0;
  std::optional<PsychometricFit> fit;
  std::vector<double> ln_own;
};

Seen see(const PerceptionSettings& settings, const Psychometric& truth, std::uint64_t seed) {
  PerceptionExperiment experiment(settings, seed);
  answer_all(experiment, truth, seed);
  Seen seen{.trials = static_cast<double>(experiment.answered().size()),
            .fit = fit_psychometric(counts_of(experiment.answered())),
            .ln_own = {}};
  for (std::size_t run = 0; run < experiment.runs(); ++run)
    if (const std::optional<double> own = experiment.estimate(run)) seen.ln_own.push_back(std::log(*own));
  return seen;
}

double mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}

double deviation(const std::vector<double>& values) {
  const double middle = mean(values);
  double sum = 0.0;
  for (const double value : values) sum += (value - middle) * (value - middle);
  return values.size() < 2 ? 0.0 : std::sqrt(sum / static_cast<double>(values.size() - 1));
}

}  // namespace

std::vector<AnsweredTrial> observe(const PerceptionSettings& settings, const Psychometric& truth, std::uint64_t seed) {
  PerceptionExperiment experiment(settings, seed);
  answer_all(experiment, truth, seed);
  return experiment.answered();
}

RuleTrial try_rule(const PerceptionSettings& settings, const Psychometric& truth, int observers, std::uint64_t seed) {
  std::vector<Seen> all(static_cast<std::size_t>(observers));
  parallel_for(all.size(), [&](std::size_t k) { all[k] = see(settings, truth, seed + k); });
  std::vector<double> trials, ln_ratio, ln_own;
  double held = 0.0;
  for (const Seen& seen : all) {
    trials.push_back(seen.trials);
    ln_own.insert(ln_own.end(), seen.ln_own.begin(), seen.ln_own.end());
    if (!seen.fit) continue;
    ln_ratio.push_back(std::log(seen.fit->function.threshold / truth.threshold));
    const bool from = !seen.fit->low || *seen.fit->low <= truth.threshold;
    const bool to = !seen.fit->high || *seen.fit->high >= truth.threshold;
    held += from && to ? 1.0 : 0.0;
  }
  const auto bounded = static_cast<double>(ln_ratio.size());
  return {.trials = mean(trials),
          .bounded = bounded / std::max(1, observers),
          .estimate = truth.threshold * std::exp(mean(ln_ratio)),
          .bias = mean(ln_ratio),
          .spread = deviation(ln_ratio),
          .held = bounded > 0.0 ? held / bounded : 0.0,
          .own = ln_own.empty() ? 0.0 : std::exp(mean(ln_own))};
}

}  // namespace rhexis::studies
