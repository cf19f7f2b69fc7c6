#pragma once

/// A change of topology as data: what an incision decides and everything else follows (mesh, matrices, factors, views,
/// recordings). Applied and taken back by TornMesh.

#include <array>
#include <vector>

#include "mesh/tet_mesh.h"

namespace rhexis::mesh {

/// A node whose reference position changed.
struct MovedNode {
  NodeId node;
  Vec3 from = Vec3::Zero();  ///< m
  Vec3 to = Vec3::Zero();    ///< m
};

/// A tet that took copies of some of its nodes.
struct RewiredTet {
  TetId tet;
  Tet before;
  Tet after;
};

struct MeshEdit {
  std::vector<TetId> removed;  ///< alive before, gone after; ascending
  std::vector<TetId> frozen;   ///< in the solve before, out of it after, since their piece lost its support; ascending
  std::vector<MovedNode> moved;  ///< no node twice; ascending
  std::vector<NodeId> copied;    ///< parent of each appended node, which starts at the parent's position after `moved`
  std::vector<RewiredTet> rewired;  ///< ascending; `after` names appended nodes as well
  /// Triangles (m) along which the mesh was cut; what lies on the side of (b - a) x (c - a) is above. The next incision
  /// of a crack joins on to them: the front that one leaves lies between nodes.
  std::vector<std::array<Vec3, 3>> swept;

  [[nodiscard]] bool empty() const {
    return removed.empty() && frozen.empty() && moved.empty() && rewired.empty() && swept.empty();
  }
};

}  // namespace rhexis::mesh
