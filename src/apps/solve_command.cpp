// rhexis solve SCENE [--out DIR] [--set key=value ...]: one equilibrium, load-stepped.

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <vector>

#include "apps/command.h"
#include "apps/progress.h"
#include "base/clock.h"
#include "base/parallel.h"
#include "result/fields.h"
#include "result/result_folder.h"
#include "result/summary.h"
#include "scene/problem.h"
#include "solver/equilibrium.h"

namespace rhexis::apps {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

struct SceneOptions {
  std::string scene;
  std::string out;
  std::vector<std::string> overrides;
};

/// Reads the scene and builds the body; prints what was noted and warned of.
Expected<scene::Problem> load(const SceneOptions& options) {
  const Expected<scene::Scene> scene = scene::read_scene(options.scene, options.overrides);
  if (!scene) return fail(scene.error());
  set_thread_count(scene->solver.threads);
  Expected<scene::Problem> problem = scene::build_problem(*scene);
  if (!problem) return fail(problem.error());
  for (const std::string& note : problem->notes) spdlog::info("{}", note);
  for (const std::string& warning : problem->warnings) spdlog::warn("{}", warning);
  return problem;
}

std::string model_text(const scene::Problem& problem) {
  return problem.model->name() == "hyperelastic" ? fmt::format("hyperelastic, beta {:.4g}", problem.settings.beta)
                                                 : std::string(problem.model->name());
}

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

/// Ctrl-C ends a run after the step in flight, with the results so far; pressed twice it ends the program.
class Interrupt {
 public:
  Interrupt() {
    asked_ = 0;
    std::signal(SIGINT, [](int) {
      asked_ = 1;
      std::signal(SIGINT, SIG_DFL);
    });
  }
  ~Interrupt() { std::signal(SIGINT, SIG_DFL); }
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;
  [[nodiscard]] bool asked() const { return asked_ != 0; }

 private:
  inline static volatile std::sig_atomic_t asked_ = 0;
};

std::string progress_text(const solver::StepReport& step) {
  return fmt::format("load {:.4g}: {} iterations, residual {:.1e}{}", step.load, step.iterations,
                     std::max(step.residual_u, step.residual_lambda), step.message.empty() ? "" : ", " + step.message);
}

int solve(const SceneOptions& options, const Common& common) {
  const Stopwatch watch;
  Expected<scene::Problem> loaded = load(options);
  if (!loaded) return report(loaded.error());
  const scene::Problem& problem = *loaded;
  const double read_seconds = watch.seconds();
  const fs::path out = options.out.empty() ? fs::path("out") / fs::path(options.scene).stem() : fs::path(options.out);
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

int check(const SceneOptions& options, const Common& common) {
  const Expected<scene::Problem> loaded = load(options);
  if (!loaded) return report(loaded.error());
  const scene::Problem& problem = *loaded;
  const ordered_json json{{"title", problem.title},
                          {"model", problem.model->name()},
                          {"nodes", problem.mesh.node_count()},
                          {"tets", problem.mesh.tet_count()},
                          {"unknowns", result::unknown_count(*problem.model, problem.loading)},
                          {"held", problem.loading.supports.size()},
                          {"dead_force", problem.loading.dead_force.norm()},
                          {"pressures", problem.loading.pressures.size()},
                          {"linear", problem.options.linear},
                          {"steps", problem.options.steps},
                          {"memory", {{"model", problem.model->memory_bytes()}}},
                          {"notes", problem.notes},
                          {"warnings", problem.warnings}};
  if (common.json) {
    print_json(json);
    return kDone;
  }
  say(common, "{}\n", problem.title);
  say(common, "body            {} nodes, {} tets, {:.4g} m^3\n", problem.mesh.node_count(), problem.mesh.tet_count(),
      mesh::total_volume(problem.mesh));
  say(common, "model           {}: {} unknowns, {} displacements held, {:.1f} MB before factorisation\n",
      model_text(problem), result::unknown_count(*problem.model, problem.loading), problem.loading.supports.size(),
      static_cast<double>(problem.model->memory_bytes()) * 1e-6);
  say(common, "would solve     {} load steps, {} solver, tolerance {:g}\n", problem.options.steps,
      problem.options.linear, problem.options.tolerance);
  say(common, "nothing is wrong with {}\n", options.scene);
  return kDone;
}

std::shared_ptr<SceneOptions> add_scene_options(CLI::App& command) {
  auto options = std::make_shared<SceneOptions>();
  command.add_option("scene", options->scene, "scene file (docs/scene.md)")->required();
  command.add_option("--set", options->overrides, "override a value of the scene, as often as wanted")
      ->type_name("KEY=VALUE")

      ->expected(1)
      ->take_all();
  return options;
}

}  // namespace

void add_solve(CLI::App& app, const Common& common, int& code) {
  CLI::App* command = app.add_subcommand("solve", "Solve one equilibrium, load step by load step");
  command->footer("Example: rhexis solve scenes/vessel.toml --out out/vessel --set model.beta=auto");
  const auto options = add_scene_options(*command);
  command->add_option("--out", options->out, "folder for the results; out/<scene> unless given");
  command->callback([options, &common, &code] { code = solve(*options, common); });
}

void add_check(CLI::App& app, const Common& common, int& code) {
  CLI::App* command = app.add_subcommand("check", "Read and validate everything, solve nothing");
  command->footer("Example: rhexis check scenes/vessel.toml");
  const auto options = add_scene_options(*command);
  command->callback([options, &common, &code] { code = check(*options, common); });
}

}  // namespace rhexis::apps
