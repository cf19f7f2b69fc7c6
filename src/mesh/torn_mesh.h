#pragma once

/// A mesh while it tears. Nodes and tets keep their numbers for good: a removed tet stays in its place and is no longer
/// alive, copies of nodes are appended. Every change is a MeshEdit, and the last one can always be taken back, to the
/// last bit.

#include <cstdint>
#include <span>
#include <vector>

#include "mesh/mesh_edit.h"
#include "mesh/tet_mesh.h"

namespace rhexis::mesh {

class TornMesh {
 public:
  /// All tets alive and in the solve.
  explicit TornMesh(TetMesh intact);

  /// Present positions and vertices; tets that are not alive keep their last ones. Node sets are the intact ones.
  [[nodiscard]] const TetMesh& mesh() const { return mesh_; }
  [[nodiscard]] std::size_t intact_node_count() const { return intact_nodes_; }

  [[nodiscard]] bool is_alive(TetId tet) const { return alive_[tet.index()] != 0; }
  /// Alive and not frozen: part of the stiffness.
  [[nodiscard]] bool is_solved(TetId tet) const { return alive_[tet.index()] != 0 && frozen_[tet.index()] == 0; }
  [[nodiscard]] bool is_frozen(TetId tet) const { return frozen_[tet.index()] != 0; }
  /// Has a tet that is alive.
  [[nodiscard]] bool is_alive(NodeId node) const { return !around_[node.index()].empty(); }
  /// Has a tet that is solved.
  [[nodiscard]] bool is_solved(NodeId node) const;
  /// The node of the intact mesh that this one is, or is a copy (of a copy ...) of.
  [[nodiscard]] NodeId original(NodeId node) const { return original_[node.index()]; }
  /// Tets around a node that are alive, ascending.
  [[nodiscard]] std::span<const TetId> tets_around(NodeId node) const { return around_[node.index()]; }

  /// How many edits have been applied and not taken back.
  [[nodiscard]] std::size_t topology() const { return history_.size(); }
  [[nodiscard]] const std::vector<MeshEdit>& history() const { return history_; }
  /// Of the tets that are alive, m^3.
  [[nodiscard]] double volume() const;

  /// The edit must fit the present topology: RHEXIS_CHECK.
  void apply(MeshEdit edit);
  /// Takes back the last edit and hands it over. There must be one.
  MeshEdit undo();

 private:
  TetMesh mesh_;
  std::size_t intact_nodes_ = 0;
  std::vector<std::uint8_t> alive_;   ///< per tet
  std::vector<std::uint8_t> frozen_;  ///< per tet
  std::vector<NodeId> original_;      ///< per node
  std::vector<std::vector<TetId>> around_;
  std::vector<MeshEdit> history_;
};

/// No other tet in the solve shares this face of one that is.
[[nodiscard]] bool is_on_solved_surface(const TornMesh& body, TetFace face);
/// All such faces; ordered. O(n).
[[nodiscard]] std::vector<TetFace> solved_surface(const TornMesh& body);

}  // namespace rhexis::mesh
