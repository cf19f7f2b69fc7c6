#include "studies/study_plate.h"

#include "base/check.h"
#include "mesh/generate.h"

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

Expected<StudyPlate> make_study_plate(int nodes) {
  Expected<mesh::TetMesh> mesh = mesh::make_plate({.size = Vec3(0.24, 0.24, 0.01)}, nodes);
  if (!mesh) return fail(std::move(mesh.error()));
  StudyPlate plate;
  plate.mesh = std::move(*mesh);
  plate.settings.body.elastic = {.young = 1.0e6, .poisson = 0.4};
  const mesh::NodeSet* held = plate.mesh.find_node_set("+x");
  RHEXIS_CHECK(held != nullptr, "a plate has six sides");
  for (const NodeId node : held->nodes)
    for (std::int32_t c = 0; c < 3; ++c) plate.settings.body.supports.push_back({3 * node.value() + c, 0.0});
  plate.settings.criterion = "maximum-principal";
  plate.settings.strength = 0.4e6;
  plate.settings.advance_threshold = 0.2e6;
  plate.cracks.push_back({{.from = Vec3(0.12, 0.0, 0.0), .to = Vec3(0.12, 0.06, 0.0), .through = Vec3::UnitZ()}});
  plate.at = Vec3(0.10, 0.0, 0.005);
  plate.by = Vec3(-0.12, 0.0, 0.0);
  return plate;
}

std::string plate_scene(std::string_view title, int nodes) { return fmt::format(kScene, title, nodes); }

Expected<std::unique_ptr<session::TearSession>> start_tearing(const StudyPlate& plate) {
  Expected<std::unique_ptr<session::TearSession>> session =
      session::TearSession::make(plate.mesh, plate.settings, plate.cracks);
  if (session) RHEXIS_CHECK((*session)->grasp(plate.at).has_value(), "a plate has a surface");
  return session;
}

}  // namespace rhexis::studies
