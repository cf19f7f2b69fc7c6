#include "fracture/torn_body.h"

#include <utility>

#include "mesh/quality.h"

namespace rhexis::fracture {

TornBody::TornBody(const mesh::TetMesh& intact, std::span<const std::int32_t> held_dofs, IncisionMethod method)
    : mesh_(intact),
      surroundings_(intact),
      method_(method),
      smallest_radius_ratio_(mesh::measure_quality(intact).radius_ratio.min),
      held_(3 * intact.node_count(), 0),
      supported_(intact.node_count(), 0) {
  for (const std::int32_t dof : held_dofs)
    held_[static_cast<std::size_t>(dof)] = supported_[static_cast<std::size_t>(dof / 3)] = 1;
  pieces_ = find_pieces(mesh_, held_);
}

IncisionSettings TornBody::incision_settings(std::span<const NodeId> in_hand) const {
  IncisionSettings settings;
  settings.method = method_;
  settings.mean_edge = mean_edge();
  settings.smallest_radius_ratio = smallest_radius_ratio_;
  settings.immovable = supported_;
  for (const NodeId node : in_hand) settings.immovable[node.index()] = 1;
  return settings;
}

void TornBody::apply(mesh::MeshEdit edit) {
  mesh_.apply(std::move(edit));
  follow_nodes();
  update_pieces(pieces_, mesh_, mesh_.history().back(), held_);
  std::vector<TetId> loose = unsupported_tets(mesh_, pieces_);
  if (!loose.empty()) {
    mesh::MeshEdit whole = mesh_.undo();
    whole.frozen = std::move(loose);
    mesh_.apply(std::move(whole));
  }
  surroundings_.follow(mesh_.history().back(), mesh_);
}

mesh::MeshEdit TornBody::undo() {
  mesh::MeshEdit edit = mesh_.undo();
  follow_nodes();
  pieces_ = find_pieces(mesh_, held_);
  return edit;
}

void TornBody::follow_nodes() {
  const std::size_t nodes = mesh_.mesh().node_count();
  const std::size_t known = supported_.size();
  held_.resize(3 * nodes, 0);
  supported_.resize(nodes, 0);
  for (std::size_t node = known; node < nodes; ++node) {
    const std::size_t parent = mesh_.original(NodeId(node)).index();
    for (std::size_t c = 0; c < 3; ++c) held_[3 * node + c] = held_[3 * parent + c];
    supported_[node] = supported_[parent];
  }
}

}  // namespace rhexis::fracture
