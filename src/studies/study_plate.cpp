#include "studies/study_plate.h"

#include "base/check.h"
#include "scene/tear_problem.h"

namespace rhexis::studies {
namespace {

constexpr std::string_view kScene = R"(title = "{}"
[mesh]
generate = "plate"
size = [0.24, 0.24, 0.01]
nodes = {}
[material]
density = 1000.0
young = 1.0e6
poisson = 0.4
[model]
kind = "linear"
[[support]]
set = "+x"
x = 0.0
y = 0.0
z = 0.0
[[crack]]
from = [0.12, 0.0, 0.0]
to = [0.12, 0.06, 0.0]
through = [0.0, 0.0, 1.0]
)";

}  // namespace

std::string plate_scene(std::string_view title, int nodes) { return fmt::format(kScene, title, nodes); }

Expected<StudyPlate> make_study_plate(int nodes) {
  const Expected<scene::Scene> scene = scene::parse_scene(plate_scene("Plate", nodes), "plate");
  if (!scene) return fail(scene.error().what, scene.error().remedy);  // the place is of a file that nobody has
  Expected<scene::TearProblem> problem = scene::build_tear_problem(*scene, scene::Puller::hand);
  if (!problem) return fail(problem.error().what, problem.error().remedy);
  StudyPlate plate;
  plate.mesh = std::move(problem->mesh);
  plate.settings.body = std::move(problem->body);
  plate.settings.criterion = "maximum-principal";
  plate.settings.strength = 0.4e6;
  plate.settings.advance_threshold = 0.2e6;
  plate.cracks = std::move(problem->cracks);
  plate.at = Vec3(0.10, 0.0, 0.005);
  plate.by = Vec3(-0.12, 0.0, 0.0);
  return plate;
}

Expected<std::unique_ptr<session::TearSession>> start_tearing(const StudyPlate& plate) {
  Expected<std::unique_ptr<session::TearSession>> session =
      session::TearSession::make(plate.mesh, plate.settings, plate.cracks);
  if (session) RHEXIS_CHECK((*session)->grasp(plate.at).has_value(), "a plate has a surface");
  return session;
}

}  // namespace rhexis::studies
