#pragma once

/// Moves of nodes that are tried one after the other, each against the positions that the earlier ones left: none may
/// turn a remaining tet inside out or make it flatter than is allowed.

#include <span>
#include <unordered_map>
#include <vector>

#include "fracture/incision.h"
#include "mesh/torn_mesh.h"

namespace rhexis::fracture {

class NodeMoves {
 public:
  /// `removed`: tets that the edit takes away and that nothing is asked of; ascending. All three must outlive this.
  NodeMoves(const mesh::TornMesh& body, std::span<const TetId> removed, const IncisionSettings& settings)
      : body_(body), removed_(removed), settings_(settings) {}

  /// Where the node is now, m.
  [[nodiscard]] const Vec3& position(NodeId node) const;
  /// Neither supported nor held nor of a frozen piece, whose shape stays.
  [[nodiscard]] bool is_movable(NodeId node) const;
  /// Has a tet that remains.
  [[nodiscard]] bool remains(NodeId node) const;

  /// Moves the node when all remaining tets around it stay upright and round enough: radius ratio >= kFlattestTet times
  /// the smallest of the intact mesh, or >= its own before the edit where that is smaller already.
  bool move(NodeId node, const Vec3& to);
  /// As far along the way to `to` as is allowed, of 1, 1/2, 1/4, 1/8. Whether it got all the way.
  bool move_towards(NodeId node, const Vec3& to);

  /// What the tets around the node would gain in volume by a move, m^3; 0 to rounding inside the body.
  [[nodiscard]] double volume_gain(NodeId node, const Vec3& to) const;

  /// All moves so far, ascending.
  [[nodiscard]] std::vector<mesh::MovedNode> moved() const;
  /// Volume before minus after, m^3, of all tets with a moved node and of the removed ones.
  [[nodiscard]] double volume_lost() const;

 private:
  [[nodiscard]] bool is_removed(TetId tet) const;
  /// Corners with the moves so far; `node` at `to`.
  [[nodiscard]] std::array<Vec3, 4> corners(TetId tet, NodeId node, const Vec3& to) const;
  [[nodiscard]] bool allows(TetId tet, const std::array<Vec3, 4>& corners) const;

  const mesh::TornMesh& body_;
  std::span<const TetId> removed_;
  const IncisionSettings& settings_;
  std::unordered_map<NodeId, Vec3> moved_;  // looked up only; moved() sorts
};

}  // namespace rhexis::fracture
