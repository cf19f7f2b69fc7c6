#pragma once

/// The edges that a swept surface crosses, and the tets that have them.

#include <span>
#include <vector>

#include "fracture/cut_geometry.h"
#include "fracture/node_moves.h"

namespace rhexis::fracture {

struct CrossedEdge {
  NodeId above;
  NodeId below;
  std::size_t triangle = 0;  ///< of the geometry: the one that is crossed
  Vec3 at = Vec3::Zero();    ///< where, m
};

/// Of the tets in `near` that are in the solve, with the moves so far; ascending by (smaller, larger) node.
[[nodiscard]] std::vector<CrossedEdge> crossed_edges(const mesh::TornMesh& body, const NodeMoves& moves,
                                                     const CutGeometry& surface, std::span<const TetId> near);

/// Tets in the solve that have one of the edges; ascending, no duplicates.
[[nodiscard]] std::vector<TetId> tets_with(const mesh::TornMesh& body, std::span<const CrossedEdge> edges);

/// Nodes of the edges; ascending, no duplicates.
[[nodiscard]] std::vector<NodeId> ends_of(std::span<const CrossedEdge> edges);

}  // namespace rhexis::fracture
