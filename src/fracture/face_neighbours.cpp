#include "fracture/face_neighbours.h"

#include <algorithm>

namespace rhexis::fracture {

TetId other_tet_with(const mesh::TornMesh& body, TetId tet, const std::array<NodeId, 3>& nodes) {
  NodeId fewest = nodes[0];
  for (const NodeId node : nodes)
    if (body.tets_around(node).size() < body.tets_around(fewest).size()) fewest = node;
  for (const TetId other : body.tets_around(fewest)) {
    if (other == tet) continue;
    const mesh::Tet& has = body.mesh().tet(other);
    const bool all = std::all_of(nodes.begin(), nodes.end(), [&](NodeId node) {
      return has[0] == node || has[1] == node || has[2] == node || has[3] == node;
    });
    if (all) return other;
  }
  return {};
}

TetId tet_across(const mesh::TornMesh& body, mesh::TetFace face) {
  return other_tet_with(body, face.tet, mesh::face_nodes(body.mesh(), face));
}

}  // namespace rhexis::fracture
