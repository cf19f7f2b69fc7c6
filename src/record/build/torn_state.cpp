#include "record/build/torn_state.h"

#include <algorithm>
#include <utility>

#include <Eigen/Geometry>

#include "fracture/path.h"

namespace rhexis::record::build {

store::Frame frame_of(const fracture::CrackLine& crack) {
  store::Frame frame;
  frame.y = (crack.to - crack.from).normalized();
  frame.z = (crack.through - crack.through.dot(frame.y) * frame.y).normalized();
  frame.x = frame.y.cross(frame.z);
  return frame;
}

Expected<TornState> TornState::begin(const mesh::TetMesh& mesh, const response::ElasticBody& elastic,
                                     const fracture::CrackLine& crack) {
  std::vector<std::int32_t> held;
  for (const model::PrescribedDof& support : elastic.supports) held.push_back(support.dof);
  TornState state{fracture::TornBody(mesh, held, fracture::IncisionMethod::keep_nodes), {}, 0};
  fracture::TornBody& body = state.body;
  Expected<fracture::FirstCut> cut =
      fracture::cut_initial(body.mesh(), crack, body.surroundings(), body.incision_settings());
  if (!cut) return fail(std::move(cut.error()));
  body.apply(std::move(cut->incision.edit));
  state.cracks = std::move(cut->start.cracks);
  return state;
}

void TornState::advance(const Vec3& direction, double length) {
  bool opened = false;
  const std::size_t fronts = cracks.size();  // those that an advance splits off wait for the next one
  for (std::size_t k = 0; k < fronts; ++k) {
    if (cracks[k].finished) continue;
    fracture::Advance step = fracture::imposed_advance(cracks[k], direction, length, body.surroundings());
    fracture::Incision incision =
        fracture::cut_along(body.mesh(), body.surroundings(), cracks[k], step, body.incision_settings());
    if (incision.edit.empty()) continue;
    opened = true;
    body.apply(std::move(incision.edit));
    std::vector<fracture::Crack> next = fracture::advanced(cracks[k], step, body.surroundings(), body.mesh());
    cracks[k] = std::move(next.front());
    cracks.insert(cracks.end(), std::make_move_iterator(next.begin() + 1), std::make_move_iterator(next.end()));
  }
  const bool through =
      std::all_of(cracks.begin(), cracks.end(), [](const fracture::Crack& one) { return one.finished; });
  flags = static_cast<std::uint8_t>((opened ? 0 : store::opened_nothing) | (through ? store::came_through : 0));
}

}  // namespace rhexis::record::build
