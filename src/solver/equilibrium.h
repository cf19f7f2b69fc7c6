#pragma once

/// One static equilibrium, load-stepped: Newton with line search, steps cut where one does not converge (section 1.4).

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/vec.h"
#include "model/loading.h"
#include "model/model.h"
#include "solver/options.h"

namespace rhexis::solver {

/// How a run, or one step of it, ended.
enum class Outcome {
  converged,  ///< both residuals below the tolerance
  stagnated,  ///< not below, but at the rounding of the arithmetic: counts as converged, and is said
  too_many_iterations,
  inverted,       ///< a tet of a law that has no answer there reached J <= 0
  not_finite,     ///< a force became NaN or infinite
  linear_solver,  ///< the linear system could not be solved; the message says why
  stopped,        ///< the observer asked for it
};
/// "converged", "stagnated", ...: the word of the summary.
[[nodiscard]] std::string_view name_of(Outcome outcome);
[[nodiscard]] constexpr bool is_success(Outcome outcome) {
  return outcome == Outcome::converged || outcome == Outcome::stagnated;
}

struct StepReport {
  double load = 0.0;  ///< fraction of the whole load at the end of this step
  Outcome outcome = Outcome::converged;
  int iterations = 0;            ///< Newton iterations
  int linear_iterations = 0;     ///< of all of them, iterative solvers
  double residual_u = 0.0;       ///< relative, at the end
  double residual_lambda = 0.0;  ///< relative, at the end
  std::string message;           ///< one line when something is to be said
  bool smaller_may_help = true;  ///< false: the failure has nothing to do with the size of the step
};

struct Report {
  Outcome outcome = Outcome::converged;
  std::string why;                ///< empty when converged
  double load = 0.0;              ///< fraction reached by the state handed back
  std::vector<StepReport> steps;  ///< accepted steps, in order
  std::vector<StepReport> cuts;   ///< steps that failed and were tried again smaller
  double residual_u = 0.0;        ///< of the last accepted step, relative
  double residual_lambda = 0.0;
  std::optional<int> negative_pivots;  ///< of the last tangent, beyond the lambdas; empty where the solver cannot know
  VectorX reaction;                    ///< N, 3 per displacement node: force of the supports on the body
  double build_seconds = 0.0;          ///< tangent and residual
  double solve_seconds = 0.0;          ///< factorisations and linear solves
  std::size_t linear_memory_bytes = 0;
  [[nodiscard]] bool converged() const { return is_success(outcome); }
};

/// Called after every accepted step, for progress and for results per step, with the force of the supports on the body
/// (N, 3 per displacement node). Returning false stops the run there; after the last step there is nothing to stop.
using StepObserver = std::function<bool(const StepReport&, const model::State&, const VectorX& reaction)>;

/// Starts from `state` (the model's initial_state, or any other) and leaves the last converged one in it.
Report solve_equilibrium(const model::Model& model, const model::Loading& loading, const Options& options,
                         model::State& state, const StepObserver& observer = {});

}  // namespace rhexis::solver
