#include "solver/equilibrium.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/log.h"
#include "solver/newton.h"

namespace rhexis::solver {
namespace {

/// A step that took at most this many iterations after a cut lets the next one be twice as long.
constexpr int kEasyIterations = 6;
/// Load fractions closer than this are the same.
constexpr double kSameLoad = 1e-12;

}  // namespace

Report solve_equilibrium(const model::Model& model, const model::Loading& loading, const Options& options,
                         model::State& state, const StepObserver& observer) {
  Report report;
  Newton newton(model, loading, options);
  const double whole_step = 1.0 / options.steps;
  double step_size = whole_step;
  int cuts_in_a_row = 0;
  model::State trial;

  while (report.load < 1.0 - kSameLoad) {
    const double wanted = report.load + step_size;
    // The last piece is joined rather than left as a sliver.
    const double target = wanted > 1.0 - 1e-3 * step_size ? 1.0 : wanted;
    trial = state;
    StepReport step = newton.solve(target, trial);
    if (is_success(step.outcome)) {
      state = trial;
      report.load = target;
      report.residual_u = step.residual_u;
      report.residual_lambda = step.residual_lambda;
      if (step.outcome == Outcome::stagnated) report.outcome = Outcome::stagnated;
      if (cuts_in_a_row > 0 && step.iterations <= kEasyIterations) step_size = std::min(2.0 * step_size, whole_step);
      cuts_in_a_row = 0;
      report.steps.push_back(step);
      if (observer) observer(report.steps.back(), state);
      continue;
    }
    spdlog::debug("load {:.6g} failed: {}", target, step.message);
    report.cuts.push_back(step);
    if (++cuts_in_a_row > options.max_cuts) {
      report.outcome = step.outcome;
      report.why = fmt::format("at load fraction {:.4g} of the whole: {}; {} halvings of the step did not help", target,
                               step.message, options.max_cuts);
      break;
    }
    step_size = 0.5 * (target - report.load);
  }

  report.negative_pivots = newton.negative_pivots();
  report.reaction = newton.reaction(report.load, state);
  report.build_seconds = newton.build_seconds();
  report.solve_seconds = newton.solve_seconds();
  report.linear_memory_bytes = newton.linear_memory_bytes();
  return report;
}

}  // namespace rhexis::solver
