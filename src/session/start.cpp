#include "session/start.h"

#include <algorithm>
#include <vector>

#include "session/scene_record.h"

namespace rhexis::session {
namespace {

/// Frames of a tick that waits, and the relative residual that it waits for.
constexpr int kMostFrames = 60;
constexpr double kScriptTolerance = 1e-6;

TearSettings settings_of(const scene::TearProblem& problem, response::SharedRecord record, Pace pace) {
  const scene::FractureSettings& fracture = problem.fracture;
  solver::LiveOptions live;
  if (pace == Pace::waits) live.tolerance = kScriptTolerance;
  std::optional<model::ModelSettings> large_strain;
  if (problem.model.kind != model::ModelKind::linear) large_strain = problem.model;
  return {
      .body = problem.body,
      .large_strain = large_strain,
      .pressures = problem.pressures,
      .solver = problem.solver,
      .live = live,
      .dynamics = problem.dynamics,
      .frames = pace == Pace::waits ? kMostFrames : 1,
      .tears = problem.tears,
      .criterion = fracture.criterion.value_or(""),
      .strength = fracture.strength,
      .toughness = fracture.toughness,
      .advance_threshold = fracture.advance_threshold.value_or(0.0),
      .ahead_only = fracture.ahead_only,
      .local_radius = fracture.local_radius.value_or(0.0),
      .incision = fracture.incision == "split" ? fracture::IncisionMethod::split : fracture::IncisionMethod::keep_nodes,
      .record = std::move(record),
      .contact = problem.interaction.blend_contact ? response::ContactRule::blend : response::ContactRule::consistent};
}

std::string placed(const scene::Place& place, const std::string& text) { return place.fail(text).value().message(); }

}  // namespace

Expected<TearStart> start_tear(const scene::TearProblem& problem, response::SharedRecord record, Pace pace) {
  TearStart start;
  if (problem.interaction.response == "recorded") {
    Expected<response::SharedRecord> read = record ? std::move(record) : load_record(problem);
    if (!read) return fail(std::move(read.error()));
    start.record = std::move(*read);
  }
  Expected<std::unique_ptr<TearSession>> made =
      TearSession::make(problem.mesh, settings_of(problem, start.record, pace), problem.cracks);
  if (!made) {
    const scene::Place& place = problem.fracture.place;
    return fail(made.error().at(place.file ? *place.file : "", place.line));
  }
  start.tear = std::move(*made);
  TearSession& tear = *start.tear;

  std::size_t frozen = 0;
  for (const mesh::MeshEdit& edit : tear.body().history()) frozen += edit.frozen.size();
  if (frozen > 0)
    start.warnings.push_back(placed(problem.cracks.front().place,
                                    fmt::format("the cracks leave {} of {} tets without support: they are frozen",
                                                frozen, problem.mesh.tet_count())));
  std::vector<Vec3> tried;  // taking hold of a soft body is work for a second
  for (const scene::PullSettings& pull : problem.pulls) {
    if (std::find(tried.begin(), tried.end(), pull.at) != tried.end()) continue;
    tried.push_back(pull.at);
    if (const Expected<void> holds = tear.grasp(pull.at); !holds)
      return pull.place.fail(holds.error().what, holds.error().remedy);
    const double away = (tear.hand().point().position - pull.at).norm();
    if (away > tear.mean_edge())
      start.warnings.push_back(placed(
          pull.place, fmt::format("the surface that the hand takes hold of is {:.3g} m from 'at', more than an edge of "
                                  "the mesh",
                                  away)));
  }
  tear.let_go();
  return start;
}

}  // namespace rhexis::session
