#include "scene/tear_problem.h"

#include "scene/body.h"
#include "scene/dynamics_choice.h"
#include "scene/model_choice.h"
#include "scene/supports.h"
#include "scene/tractions.h"

namespace rhexis::scene {
namespace {

std::string model_name(const Scene& scene) {
  return in_quotes(model::kModelNames[static_cast<std::size_t>(scene.model.kind)]);
}

/// The linear model bends no surface that a pressure could follow.
Expected<void> check_pressures(const Scene& scene) {
  if (scene.model.kind == model::ModelKind::linear && !scene.pressures.empty())
    return scene.pressures.front().faces.place.fail("a pressure follows the surface, which the linear model cannot",
                                                    "a [[traction]] in a fixed direction");
  return {};
}

/// What a record is of.
Expected<void> check_linear(const Scene& scene) {
  if (scene.model.kind != model::ModelKind::linear)
    return scene.model.kind_place.fail(
        fmt::format("a record is of a body of small strains, not of model {}", model_name(scene)), "kind = \"linear\"");
  return check_pressures(scene);
}

/// What a body of large strain does not have, whoever asks.
Expected<void> check_large_strain(const Scene& scene) {
  if (scene.model.kind == model::ModelKind::linear || !model::is_live(scene.model.kind)) return {};
  if (scene.interaction.blend_contact && scene.interaction.place)
    return scene.interaction.place->fail(
        fmt::format("contact \"blend\" adds up reactions, which model {} does not allow", model_name(scene)),
        "contact = \"consistent\"");
  return {};
}

/// What a script needs, as far as it can be seen without the mesh.
Expected<void> check_script(const Scene& scene) {
  if (!scene.fracture)
    return fail("the scene does not say when the body tears", "add a [fracture] with 'strength' or 'toughness'",
                scene.file);
  if (scene.pulls.empty()) return fail("nothing pulls at the body", "add a [[pull]]", scene.file);
  if (!model::is_live(scene.model.kind))
    return scene.model.kind_place.fail(fmt::format("a body with model {} cannot be torn", model_name(scene)),
                                       "\"linear\", \"corotated\", \"geometrically-nonlinear\" or \"hyperelastic\"");
  return check_pressures(scene);
}

/// The same for a record.
Expected<void> check_record(const Scene& scene) {
  if (scene.cracks.size() != 1) {
    const std::string what = fmt::format("{} cracks, of which a record follows one", scene.cracks.size());
    return scene.cracks.empty() ? fail(what, "add a [[crack]]", scene.file)
                                : scene.cracks[1].place.fail(what, "one [[crack]]");
  }
  if (scene.fracture && scene.fracture->incision != "keep-nodes")
    return scene.fracture->place.fail(fmt::format("incision {} adds nodes, and a record needs operators of one size",
                                                  in_quotes(scene.fracture->incision)),
                                      "incision = \"keep-nodes\"");
  if (record::store::Numbering::count_of(scene.record.parameters) > record::store::kMostTopologies)
    return fail(fmt::format("the record has more than {} topologies", record::store::kMostTopologies),
                "fewer advances, directions or lengths in [record]", scene.file);
  return check_linear(scene);
}

/// What a hand does without, in words.
void warn_hand(const Scene& scene, std::vector<std::string>& warnings) {
  const auto warn = [&](const Place& place, const std::string& what) {
    warnings.push_back(place.fail(what).value().message());
  };
  if (!scene.fracture) warnings.push_back(scene.file + ": the body bends and does not tear: there is no [fracture]");
  const bool is_live = model::is_live(scene.model.kind);
  if (!is_live)
    warn(scene.model.kind_place,
         fmt::format("model {} is not live: the body is opened as 'linear'", model_name(scene)));
  for (const PressureSettings& pressure : scene.pressures)
    if (!is_live || scene.model.kind == model::ModelKind::linear)
      warn(pressure.faces.place,
           "the pressure acts on the surface as it was at rest: the linear model does not turn it");
}

/// force += the pressures (N) on the undeformed surface.
Expected<void> add_pressures_at_rest(const Scene& scene, const Body& body, const model::DisplacementSpace& space,
                                     VectorX& force) {
  const VectorX rest = VectorX::Zero(force.size());
  for (const PressureSettings& pressure : scene.pressures) {
    const Expected<std::vector<mesh::TetFace>> faces = faces_of(body, pressure.faces);
    if (!faces) return fail(faces.error());
    model::add_pressure_force(model::make_follower_pressure(body.mesh, space, *faces, pressure.value, {}), space, rest,
                              1.0, force);
  }
  return {};
}

/// As they follow the surface.
Expected<void> take_pressures(const Scene& scene, const Body& body, std::vector<response::SurfacePressure>& out) {
  for (const PressureSettings& pressure : scene.pressures) {
    Expected<std::vector<mesh::TetFace>> faces = faces_of(body, pressure.faces);
    if (!faces) return fail(std::move(faces.error()));
    out.push_back({.faces = std::move(*faces), .value = pressure.value});
  }
  return {};
}

}  // namespace

bool is_for_tearing(const Scene& scene) { return scene.fracture.has_value() && !scene.pulls.empty(); }

Expected<TearProblem> build_tear_problem(const Scene& scene, Puller puller) {
  TearProblem problem;
  problem.warnings = scene.warnings;
  if (puller == Puller::hand) warn_hand(scene, problem.warnings);
  Expected<void> checked;
  if (puller == Puller::script) checked = check_script(scene);
  if (checked && (puller == Puller::record || scene.interaction.response == "recorded")) checked = check_record(scene);
  if (checked) checked = check_large_strain(scene);
  if (!checked) return fail(std::move(checked.error()));
  problem.title = title_of(scene);
  problem.body.elastic = scene.material.elastic;
  problem.body.density = scene.material.density;
  problem.body.gravity = scene.gravity;
  problem.tears = scene.fracture.has_value();
  if (problem.tears) problem.fracture = *scene.fracture;
  problem.cracks = scene.cracks;
  problem.record = scene.record;
  problem.interaction = scene.interaction;
  problem.pulls = scene.pulls;
  problem.notes = scene.notes;
  problem.solver = scene.solver.options;
  Expected<Body> body = make_body(scene, problem.notes);
  if (!body) return fail(std::move(body.error()));
  Expected<std::optional<solver::Dynamics>> dynamics = choose_dynamics(scene, body->mesh, problem.warnings);
  if (!dynamics) return fail(std::move(dynamics.error()));
  problem.dynamics = *dynamics;
  const model::DisplacementSpace space = model::make_p1_space(body->mesh);
  Expected<std::vector<model::PrescribedDof>> supports = make_supports(scene, *body, space);
  if (!supports) return fail(std::move(supports.error()));
  problem.body.supports = std::move(*supports);
  problem.body.dead_force = VectorX::Zero(static_cast<Eigen::Index>(space.dof_count()));
  if (Expected<void> done = add_tractions(scene, *body, space, problem.body.dead_force); !done)
    return fail(std::move(done.error()));
  problem.model.kind = model::ModelKind::linear;
  if (model::is_live(scene.model.kind))
    problem.model = choose_model(scene, body->mesh, problem.notes, problem.warnings);
  const bool follow = problem.model.kind != model::ModelKind::linear;
  Expected<void> pressed = follow ? take_pressures(scene, *body, problem.pressures)
                                  : add_pressures_at_rest(scene, *body, space, problem.body.dead_force);
  if (!pressed) return fail(std::move(pressed.error()));
  if (!(scene.material.density * scene.gravity).allFinite())
    return fail("the weight is too large for a computer's numbers", "a smaller density or gravity", scene.file);
  problem.mesh = std::move(body->mesh);
  return problem;
}

}  // namespace rhexis::scene
