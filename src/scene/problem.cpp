#include "scene/problem.h"

#include <algorithm>

#include "scene/body.h"
#include "scene/model_choice.h"
#include "scene/supports.h"
#include "scene/tractions.h"

namespace rhexis::scene {
namespace {

Expected<model::Loading> make_loading(const Scene& scene, const Body& body, const model::DisplacementSpace& space) {
  model::Loading loading;
  Expected<std::vector<model::PrescribedDof>> supports = make_supports(scene, body, space);
  if (!supports) return fail(std::move(supports.error()));
  loading.supports = std::move(*supports);

  loading.dead_force = VectorX::Zero(static_cast<Eigen::Index>(space.dof_count()));
  const Vec3 weight = scene.material.density * scene.gravity;
  if (!weight.isZero(0.0)) model::add_body_force(body.mesh, space, weight, loading.dead_force);
  if (Expected<void> done = add_tractions(scene, body, space, loading.dead_force); !done)
    return fail(std::move(done.error()));
  for (const PressureSettings& pressure : scene.pressures) {
    const Expected<std::vector<mesh::TetFace>> faces = faces_of(body, pressure.faces);
    if (!faces) return fail(faces.error());
    loading.pressures.push_back(
        model::make_follower_pressure(body.mesh, space, *faces, pressure.value, loading.supports));
    if (!loading.pressures.back().closed_or_held_rim && scene.solver.options.linear != "direct")
      return pressure.faces.place.fail(
          fmt::format("a follower pressure on a surface with a free rim makes the tangent non-symmetric, which {} "
                      "cannot solve",
                      in_quotes(scene.solver.options.linear)),
          "linear = \"direct\", or hold the rim");
  }
  return loading;
}

/// What the scene says to `rhexis tear` and `rhexis play` only.
void warn_of_tearing(const Scene& scene, std::vector<std::string>& warnings) {
  const auto warn = [&](const Place& place, std::string_view section) {
    const auto unread = place.fail(in_quotes(section) + " is not read by `rhexis solve`", "`rhexis tear` reads it");
    warnings.push_back(unread.value().message());
  };
  if (scene.dynamics) warn(scene.dynamics->place, "dynamics");
  if (scene.fracture) warn(scene.fracture->place, "fracture");
  if (!scene.cracks.empty()) warn(scene.cracks.front().place, "crack");
  if (scene.interaction.place) warn(*scene.interaction.place, "interaction");
  if (!scene.pulls.empty()) warn(scene.pulls.front().place, "pull");
}

bool acts(const model::Loading& loading) {
  const auto moves = [](const model::PrescribedDof& dof) { return dof.value != 0.0; };
  const auto presses = [](const model::FollowerPressure& load) { return load.pressure != 0.0; };
  return !loading.dead_force.isZero(0.0) || std::any_of(loading.supports.begin(), loading.supports.end(), moves) ||
         std::any_of(loading.pressures.begin(), loading.pressures.end(), presses);
}

}  // namespace

Expected<Problem> build_problem(const Scene& scene) {
  Problem problem;
  problem.title = title_of(scene);
  problem.options = scene.solver.options;
  problem.warnings = scene.warnings;
  problem.notes = scene.notes;
  warn_of_tearing(scene, problem.warnings);

  Expected<Body> body = make_body(scene, problem.notes);
  if (!body) return fail(std::move(body.error()));
  problem.settings = choose_model(scene, body->mesh, problem.notes, problem.warnings);
  problem.model = model::make_model(body->mesh, problem.settings);
  Expected<model::Loading> loading = make_loading(scene, *body, problem.model->space());
  if (!loading) return fail(std::move(loading.error()));
  problem.loading = std::move(*loading);
  if (!acts(problem.loading) && scene.pulls.empty())
    problem.warnings.push_back(scene.file + ": nothing acts on the body: no load, and no support moves");
  problem.mesh = std::move(body->mesh);
  return problem;
}

}  // namespace rhexis::scene
