#pragma once

/// What a Newton iteration costs (Table 6 of the paper), and what one iteration per simulation step buys and costs
/// (6.3; docs/studies.md): study `timing`.

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "result/chart.h"
#include "studies/study_folder.h"

namespace rhexis::studies {

struct TimingOptions {
  std::vector<int> nodes{401, 1000, 3000, 10'000, 30'000};  ///< of the vessels
  std::vector<int> threads{1, 2};
  std::vector<std::string> solvers{"direct", "cg", "minres"};
  double hand = 0.05;  ///< m/s, at which the load moves in one-iteration-per-step stepping
};

/// Writes timing.csv, .json: one row per mesh, threads, model and linear solver, of nodes, tets, threads, model,
/// linear, outcome ("converged", another outcome of the solver, or why it was left out), iterations, build_ms (a
/// tangent and the residuals that go with it, per Newton iteration), tangent_ms (the tangent alone), solve_ms (factor
/// and solve), iteration_ms, and tangent_ratio, solve_ratio, iteration_ratio (over the corotated tangent, and over the
/// corotated iteration by `direct`, of the same mesh and threads). timing-steps: one row per mesh and model, stepped
/// with one iteration a step as fast as it goes. Figures. Gives the rows of timing. Errors: a vessel that cannot be, an
/// unknown solver. Changes the number of threads, and sets it back.
Expected<nlohmann::ordered_json> run_timing(const TimingOptions& options, const StudyFolder& folder,
                                            const Progress& progress);

}  // namespace rhexis::studies
