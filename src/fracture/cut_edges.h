#pragma once

/// The edges that a swept surface crosses, and the tets that have them.

#include <span>
#include <utility>
#include <vector>

#include "fracture/cut_geometry.h"
#include "fracture/front_surroundings.h"
#include "fracture/node_moves.h"

namespace rhexis::fracture {

/// Tets in the solve whose box meets that of a triangle, inside `within`; ascending. All that the surface touches there
/// is among them.
[[nodiscard]] std::vector<TetId> tets_near(const mesh::TornMesh& body, const Surroundings& surroundings,
                                           const CutGeometry& surface, const mesh::BoundingBox& within);

/// Smaller node first.
using Edge = std::pair<NodeId, NodeId>;

/// Ascending, no duplicates.
[[nodiscard]] std::vector<Edge> edges_of(const mesh::TornMesh& body, std::span<const TetId> tets);

struct CrossedEdge {
  NodeId above;
  NodeId below;
  std::size_t triangle = 0;  ///< of the geometry: the one that is crossed
  Vec3 at = Vec3::Zero();    ///< where, m
};

/// Of `edges`, with the moves so far; in their order.
[[nodiscard]] std::vector<CrossedEdge> crossed_edges(const NodeMoves& moves, const CutGeometry& surface,
                                                     std::span<const Edge> edges);

/// Tets in the solve that have one of the edges; ascending, no duplicates.
[[nodiscard]] std::vector<TetId> tets_with(const mesh::TornMesh& body, std::span<const CrossedEdge> edges);

/// Nodes of the edges; ascending, no duplicates.
[[nodiscard]] std::vector<NodeId> ends_of(std::span<const CrossedEdge> edges);

}  // namespace rhexis::fracture
