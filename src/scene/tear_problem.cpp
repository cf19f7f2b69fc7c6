#include "scene/tear_problem.h"

#include "scene/body.h"
#include "scene/supports.h"
#include "scene/tractions.h"

namespace rhexis::scene {
namespace {

/// What can be seen without the mesh.
Expected<void> check_sections(const Scene& scene) {
  if (!scene.fracture)
    return fail("the scene does not say when the body tears", "add a [fracture] with 'strength' or 'toughness'",
                scene.file);
  if (scene.pulls.empty()) return fail("nothing pulls at the body", "add a [[pull]]", scene.file);
  if (scene.model.kind != model::ModelKind::linear)
    return scene.model.kind_place.fail(
        fmt::format("a body with model {} cannot be torn yet",
                    in_quotes(model::kModelNames[static_cast<std::size_t>(scene.model.kind)])),
        "kind = \"linear\"");
  if (!scene.pressures.empty())
    return scene.pressures.front().faces.place.fail("a pressure follows the surface, which the linear model cannot",
                                                    "a [[traction]] in a fixed direction");
  if (scene.interaction.response == "recorded")
    return scene.interaction.place->fail("response = \"recorded\" is not there yet", "response = \"exact\"");
  return {};
}

}  // namespace

bool is_for_tearing(const Scene& scene) { return scene.fracture.has_value() && !scene.pulls.empty(); }

Expected<TearProblem> build_tear_problem(const Scene& scene) {
  if (Expected<void> done = check_sections(scene); !done) return fail(std::move(done.error()));
  TearProblem problem;
  problem.title = title_of(scene);
  problem.body.elastic = scene.material.elastic;
  problem.body.density = scene.material.density;
  problem.body.gravity = scene.gravity;
  problem.fracture = *scene.fracture;
  problem.cracks = scene.cracks;
  problem.interaction = scene.interaction;
  problem.pulls = scene.pulls;
  problem.warnings = scene.warnings;
  problem.notes = scene.notes;

  Expected<Body> body = make_body(scene, problem.notes);
  if (!body) return fail(std::move(body.error()));
  const model::DisplacementSpace space = model::make_p1_space(body->mesh);
  Expected<std::vector<model::PrescribedDof>> supports = make_supports(scene, *body, space);
  if (!supports) return fail(std::move(supports.error()));
  problem.body.supports = std::move(*supports);
  problem.body.dead_force = VectorX::Zero(static_cast<Eigen::Index>(space.dof_count()));
  if (Expected<void> done = add_tractions(scene, *body, space, problem.body.dead_force); !done)
    return fail(std::move(done.error()));
  if (!(scene.material.density * scene.gravity).allFinite())
    return fail("the weight is too large for a computer's numbers", "a smaller density or gravity", scene.file);
  problem.mesh = std::move(body->mesh);
  return problem;
}

}  // namespace rhexis::scene
