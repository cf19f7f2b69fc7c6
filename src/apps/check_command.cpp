// rhexis check SCENE: read and validate everything, solve nothing.

#include "apps/model_text.h"
#include "apps/scene_options.h"
#include "result/summary.h"
#include "scene/problem.h"
#include "scene/tear_problem.h"
#include "session/script.h"
#include "session/start.h"

namespace rhexis::apps {
namespace {

using nlohmann::ordered_json;

int check_solve(const scene::Scene& scene, const std::string& name, const Common& common) {
  const Expected<scene::Problem> built = scene::build_problem(scene);
  if (!built) return report(built.error());
  const scene::Problem& problem = *built;
  log_remarks(problem.notes, problem.warnings);
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
  say(common, "nothing is wrong with {}\n", name);
  return kDone;
}

int check_tear(const scene::Scene& scene, const std::string& name, const Common& common) {
  const Expected<scene::TearProblem> built = scene::build_tear_problem(scene);
  if (!built) return report(built.error());
  const scene::TearProblem& problem = *built;
  log_remarks(problem.notes, problem.warnings);
  const Expected<session::TearStart> start = session::start_tear(problem);
  if (!start) return report(start.error());
  log_remarks({}, start->warnings);
  const double seconds = session::script_seconds(problem.pulls);
  if (common.json) {
    print_json({{"title", problem.title},
                {"model", start->tear->model_name()},
                {"nodes", problem.mesh.node_count()},
                {"tets", problem.mesh.tet_count()},
                {"unknowns", 3 * problem.mesh.node_count() - problem.body.supports.size()},
                {"held", problem.body.supports.size()},
                {"cracks", problem.cracks.size()},
                {"pulls", problem.pulls.size()},
                {"seconds", seconds},
                {"notes", problem.notes},
                {"warnings", problem.warnings}});
    return kDone;
  }
  say(common, "{}\n", problem.title);
  say(common, "body            {} nodes, {} tets, {:.4g} m^3\n", problem.mesh.node_count(), problem.mesh.tet_count(),
      mesh::total_volume(problem.mesh));
  say(common, "model           {}: {} unknowns, {} displacements held\n", start->tear->model_name(),
      3 * problem.mesh.node_count() - problem.body.supports.size(), problem.body.supports.size());
  say(common, "would tear      {} cracks to start with, {} pulls, {:g} s in ticks of 1 ms\n", problem.cracks.size(),
      problem.pulls.size(), seconds);
  say(common, "nothing is wrong with {}\n", name);
  return kDone;
}

int check(const SceneOptions& options, const Common& common) {
  const Expected<scene::Scene> scene = read_scene(options);
  if (!scene) return report(scene.error());
  return scene::is_for_tearing(*scene) ? check_tear(*scene, options.scene, common)
                                       : check_solve(*scene, options.scene, common);
}

}  // namespace

void add_check(CLI::App& app, const Common& common, int& code) {
  CLI::App* command = app.add_subcommand("check", "Read and validate everything, solve nothing");
  command->footer("Example: rhexis check scenes/vessel.toml");
  const auto options = add_scene_options(*command);
  command->callback([options, &common, &code] { code = check(*options, common); });
}

}  // namespace rhexis::apps
