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
/// A run ends after this many times max_cuts failed steps in all: near a limit point of the load steps would go on
/// being cut and doubled while the load creeps up to it.
constexpr int kCutsOfARun = 5;
/// Load fractions closer than this are the same.
constexpr double kSameLoad = 1e-12;

}  // namespace

std::string_view name_of(Outcome outcome) {
  switch (outcome) {
    case Outcome::converged: return "converged";
    case Outcome::stagnated: return "stagnated";
    case Outcome::too_many_iterations: return "too-many-iterations";
    case Outcome::inverted: return "inverted";
    case Outcome::not_finite: return "not-finite";
    case Outcome::linear_solver: return "linear-solver";
    case Outcome::stopped: return "stopped";
  }
  return "";
}

Report solve_equilibrium(const model::Model& model, const model::Loading& loading, const Options& options,
                         model::State& state, const StepObserver& observer) {
  Report report;
  Newton newton(model, loading, options);
  const double whole_step = 1.0 / options.steps;
  int halvings = 0;  // of the whole step, at present
  model::State trial = state;
  report.reaction = VectorX::Zero(state.u.size());

  while (report.load < 1.0 - kSameLoad) {
    const double step_size = std::ldexp(whole_step, -halvings);
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
      report.negative_pivots = newton.negative_pivots();
      report.reaction = newton.reaction(target, state);
      report.outcome = std::max(report.outcome, step.outcome);
      if (halvings > 0 && step.iterations <= kEasyIterations) --halvings;
      report.steps.push_back(step);
      const bool go_on = !observer || observer(report.steps.back(), state, report.reaction);
      if (!go_on && report.load < 1.0 - kSameLoad) {
        report.outcome = Outcome::stopped;
        report.why = fmt::format("stopped at load fraction {:.4g} of the whole", target);
        break;
      }
      continue;
    }
    spdlog::debug("load {:.6g} failed: {}", target, step.message);
    report.cuts.push_back(step);
    const std::string at = fmt::format("at load fraction {:.4g} of the whole: {}", target, step.message);
    if (!step.smaller_may_help) {
      report.why = at;
    } else if (++halvings > options.max_cuts) {
      report.why = fmt::format("{}; {} halvings of the step did not help", at, options.max_cuts);
    } else if (report.cuts.size() > static_cast<std::size_t>(kCutsOfARun * options.max_cuts)) {
      report.why = fmt::format("{}; {} steps had to be cut on the way", at, report.cuts.size());
    }
    if (!report.why.empty()) {
      report.outcome = step.outcome;
      break;
    }
  }

  report.build_seconds = newton.build_seconds();
  report.solve_seconds = newton.solve_seconds();
  report.linear_memory_bytes = newton.linear_memory_bytes();
  return report;
}

}  // namespace rhexis::solver
