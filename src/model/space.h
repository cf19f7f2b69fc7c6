#pragma once

/// The displacement space: which nodes carry unknowns and which of them each tet has.

#include <array>
#include <cstdint>
#include <vector>

#include "mesh/tet_mesh.h"

namespace rhexis::model {

/// The edges of a mesh and which of them each tet has.
struct EdgeTable {
  std::vector<std::array<NodeId, 2>> edges;         ///< (smaller, larger) end; ascending, no duplicates
  std::vector<std::array<std::int32_t, 6>> of_tet;  ///< per tet, in the order of mesh::kTetEdges: index into `edges`
};

/// O(n log n) by sorting; deterministic.
[[nodiscard]] EdgeTable find_edges(const mesh::TetMesh& mesh);

/// P1: the nodes of the mesh. P2: those, then one node at the middle of every edge, ordered by (smaller, larger) end.
struct DisplacementSpace {
  int order = 1;            ///< 1 or 2
  std::vector<Vec3> nodes;  ///< reference position X, m
  std::vector<std::int32_t>
      connectivity;  ///< nodes_per_tet() per tet; P2: 4 vertices, then the edges of mesh::kTetEdges
  std::vector<std::array<NodeId, 2>> edges;  ///< P2: the ends of edge node mesh.node_count() + i; P1: empty

  [[nodiscard]] int nodes_per_tet() const { return order == 1 ? 4 : 10; }
  [[nodiscard]] std::size_t node_count() const { return nodes.size(); }
  [[nodiscard]] std::size_t dof_count() const { return 3 * nodes.size(); }
  /// How many of the nodes are nodes of the mesh: the first ones.
  [[nodiscard]] std::size_t vertex_count() const { return nodes.size() - edges.size(); }
};

[[nodiscard]] DisplacementSpace make_p1_space(const mesh::TetMesh& mesh);
[[nodiscard]] DisplacementSpace make_p2_space(const mesh::TetMesh& mesh);

/// The nodes of the space that lie on a set of mesh nodes: those nodes and, for P2, the middles of edges with both ends
/// in the set. Ascending, no duplicates.
[[nodiscard]] std::vector<std::int32_t> nodes_of_set(const DisplacementSpace& space, const std::vector<NodeId>& set);

/// The nodes of the space on a face of a tet, counter-clockwise seen from outside: 3 vertices, then for P2 the middles
/// of the edges 01, 12, 20 (P1: those three are -1).
[[nodiscard]] std::array<std::int32_t, 6> nodes_of_face(const DisplacementSpace& space, mesh::TetFace face);

}  // namespace rhexis::model
