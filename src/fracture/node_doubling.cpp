#include "fracture/node_doubling.h"

#include <algorithm>
#include <map>
#include <vector>

#include "fracture/face_neighbours.h"

namespace rhexis::fracture {
namespace {

/// Per tet around a node: its part, numbered in the order of the lowest tets.
std::vector<int> parts_around(const mesh::TornMesh& body, NodeId node, std::span<const mesh::TetFace> opened) {
  const auto tets = body.tets_around(node);
  std::vector<int> part(tets.size(), -1);
  std::vector<std::size_t> open;
  int count = 0;
  for (std::size_t start = 0; start < tets.size(); ++start) {
    if (part[start] >= 0) continue;
    part[start] = count;
    open.assign(1, start);
    while (!open.empty()) {
      const TetId tet = tets[open.back()];
      open.pop_back();
      for (std::int8_t k = 0; k < 4; ++k) {
        const mesh::TetFace face{tet, k};
        if (body.mesh().tet(tet)[static_cast<std::size_t>(k)] == node) continue;  // the face away from the node
        if (std::binary_search(opened.begin(), opened.end(), face)) continue;
        const TetId next = tet_across(body, face);
        if (!next.valid()) continue;
        const auto at = static_cast<std::size_t>(std::lower_bound(tets.begin(), tets.end(), next) - tets.begin());
        if (part[at] >= 0) continue;
        part[at] = count;
        open.push_back(at);
      }
    }
    ++count;
  }
  return part;
}

}  // namespace

void double_nodes(const mesh::TornMesh& body, std::span<const mesh::TetFace> opened, mesh::MeshEdit& edit) {
  std::vector<NodeId> nodes;
  for (const mesh::TetFace& face : opened)
    for (const NodeId node : mesh::face_nodes(body.mesh(), face)) nodes.push_back(node);
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());

  std::map<TetId, mesh::Tet> after;
  for (const NodeId node : nodes) {
    const std::vector<int> part = parts_around(body, node, opened);
    const std::size_t first_copy = body.mesh().node_count() + edit.copied.size() - 1;  // of part 1, less one
    for (std::size_t i = 0; i < part.size(); ++i) {
      if (part[i] == 0) continue;
      const TetId tet = body.tets_around(node)[i];
      mesh::Tet& nodes_after = after.try_emplace(tet, body.mesh().tet(tet)).first->second;
      std::replace(nodes_after.begin(), nodes_after.end(), node,
                   NodeId(first_copy + static_cast<std::size_t>(part[i])));
    }
    const int copies = part.empty() ? 0 : *std::max_element(part.begin(), part.end());
    edit.copied.insert(edit.copied.end(), static_cast<std::size_t>(copies), node);
  }
  for (const auto& [tet, nodes_after] : after) edit.rewired.push_back({tet, body.mesh().tet(tet), nodes_after});
}

}  // namespace rhexis::fracture
