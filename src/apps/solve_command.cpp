// rhexis solve SCENE [--out DIR] [--set key=value ...]: one equilibrium, load-stepped.

#include <algorithm>
#include <filesystem>
#include <vector>

#include "apps/interrupt.h"
#include "apps/model_text.h"
#include "apps/progress.h"
#include "apps/scene_options.h"
#include "base/clock.h"
#include "result/fields.h"
#include "result/result_folder.h"
#include "result/summary.h"
#include "scene/problem.h"
#include "solver/equilibrium.h"

namespace rhexis::apps {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

void print_outcome(const ordered_json& summary, const fs::path& out) {
  const auto& time = summary["time"];
  const std::vector<int> iterations = summary["iterations"];
  int total = 0;
  for (const int count : iterations) total += count;
  if (summary["converged"].get<bool>())
    fmt::print("converged       {} steps, {} iterations, residual {:.1e}{}\n", iterations.size(), total,
               summary["residual"].get<double>(),
               summary["outcome"] == "stagnated" ? ", the rounding of the arithmetic: above the tolerance" : "");
  else
    fmt::print("NOT converged   {}\n", summary["why"].get<std::string>());
  if (!summary["negative_pivots"].is_null() && summary["negative_pivots"].get<int>() > 0)
    fmt::print("unstable        the tangent has {} negative eigenvalues too many: the body would buckle\n",
               summary["negative_pivots"].get<int>());
  fmt::print("displacement    {:.4g} m at most\nvolume          {:.6f} of the reference, {} tets inside out\n",
             summary["max_displacement"].get<double>(), summary["volume_ratio"].get<double>(),
             summary["inverted_tets"].get<int>());
  fmt::print("pressure jump   {:.3g}\n", summary["pressure_jump"].get<double>());
  fmt::print("time            {:.2f} s: {:.2f} read, {:.2f} build, {:.2f} solve; {:.0f} MB at most\n",
             time["total"].get<double>(), time["read"].get<double>(), time["build"].get<double>(),
             time["solve"].get<double>(), summary["memory"]["peak"].get<double>() * 1e-6);
  fmt::print("results         {}\n", (out / "result.vtkhdf").string());
}

std::string progress_text(const solver::StepReport& step) {
  return fmt::format("load {:.4g}: {} iterations, residual {:.1e}{}", step.load, step.iterations,
                     std::max(step.residual_u, step.residual_lambda), step.message.empty() ? "" : ", " + step.message);
}

int solve(const SceneOptions& options, const Common& common) {
  const Stopwatch watch;
  const Expected<scene::Scene> scene = read_scene(options);
  if (!scene) return report(scene.error());
  const Expected<scene::Problem> built = scene::build_problem(*scene);
  if (!built) return report(built.error());
  const scene::Problem& problem = *built;
  log_remarks(problem.notes, problem.warnings);
  const double read_seconds = watch.seconds();
  const fs::path out = options.folder();
  Expected<result::ResultFolder> folder = result::ResultFolder::open(out);
  if (!folder) return report(folder.error());
  say(common, "{}\nbody            {} nodes, {} tets, {} unknowns\nmodel           {}, {} solver\n", problem.title,
      problem.mesh.node_count(), problem.mesh.tet_count(), result::unknown_count(*problem.model, problem.loading),
      model_text(problem), problem.options.linear);

  model::State state = problem.model->initial_state();
  Expected<void> written;
  solver::Report outcome;
  {
    const Interrupt interrupt;
    Progress progress(!common.quiet);
    const auto observe = [&](const solver::StepReport& step, const model::State& at, const VectorX& reaction) {
      progress.update(step.load, progress_text(step));
      written = folder->write_step(
          step.load, problem.mesh,
          result::make_fields(problem.mesh, *problem.model, at, problem.model->fields(at), reaction));
      return written.has_value() && !interrupt.asked();
    };
    outcome = solver::solve_equilibrium(*problem.model, problem.loading, problem.options, state, observe);
  }
  const model::TetFields tets = problem.model->fields(state);
  if (written)
    written = folder->write_result(problem.mesh,
                                   result::make_fields(problem.mesh, *problem.model, state, tets, outcome.reaction));

  const result::RunDescription run{.title = problem.title,
                                   .scene = options.scene,
                                   .model = std::string(problem.model->name()),
                                   .linear = problem.options.linear,
                                   .beta = problem.settings.beta,
                                   .notes = problem.notes,
                                   .warnings = problem.warnings};
  const ordered_json summary = result::make_summary(run, problem.mesh, *problem.model, problem.loading,
                                                    result::measure(problem.mesh, state, tets), outcome,
                                                    {.read = read_seconds, .total = watch.seconds()});
  if (written) written = folder->write_summary(summary);
  if (!written) {
    report(written.error());
    return kFailedComputation;  // the input was good: the disk filled up, or the folder went away
  }

  if (common.json) print_json(summary);
  if (!common.json && !common.quiet) print_outcome(summary, out);
  if (outcome.converged()) return kDone;
  fmt::print(stderr, "rhexis: {}: not converged: {}\n", options.scene, outcome.why);
  return kFailedComputation;
}

}  // namespace

void add_solve(CLI::App& app, const Common& common, int& code) {
  CLI::App* command = app.add_subcommand("solve", "Solve one equilibrium, load step by load step");
  command->footer("Example: rhexis solve scenes/vessel.toml --out out/vessel --set model.beta=auto");
  const auto options = add_scene_options(*command);
  add_out_option(*command, *options);
  command->callback([options, &common, &code] { code = solve(*options, common); });
}

}  // namespace rhexis::apps
