#pragma once

/// Brings the nodes of a mesh to the surface that is to cut it, as far as their tets allow.

#include <map>
#include <span>
#include <unordered_set>
#include <vector>

#include "fracture/cut_edges.h"

namespace rhexis::fracture {

class Snapping {
 public:
  /// `near`: of tets_near. Everything must outlive this.
  Snapping(const mesh::TornMesh& body, const CutGeometry& surface, const IncisionSettings& settings,
           std::span<const TetId> near);

  /// The nearer end of each crossed edge goes to the surface, or the other one when that may not move there, or none.
  void snap();

  [[nodiscard]] const NodeMoves& moves() const { return moves_; }
  [[nodiscard]] bool is_on(NodeId node) const { return on_.count(node) != 0; }
  /// Nodes on the surface; ascending.
  [[nodiscard]] std::vector<NodeId> nodes_on() const;
  /// Edges from above to below with neither end on the surface: where it could not be come by. In order of their nodes.
  [[nodiscard]] std::vector<CrossedEdge> crossed() const;

 private:
  [[nodiscard]] double height(NodeId node, std::size_t triangle) const;
  [[nodiscard]] std::vector<CrossedEdge> passing() const;
  [[nodiscard]] bool passes(const CrossedEdge& edge) const;
  [[nodiscard]] bool is_still_crossed(const CrossedEdge& edge) const;
  bool snap_once();
  bool bring(NodeId node, std::span<const CrossedEdge> edges, const std::vector<std::size_t>& own);

  const CutGeometry& surface_;
  std::vector<Edge> edges_;
  NodeMoves moves_;
  double least_gain_ = 0.0;        ///< m^3: a smaller change of volume is rounding
  std::unordered_set<NodeId> on_;  // looked up only; nodes_on() sorts
};

}  // namespace rhexis::fracture
