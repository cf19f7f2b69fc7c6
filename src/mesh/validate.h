#pragma once

/// Defects that make a mesh unusable, each named by its tet or face, and the orientation repair that readers apply.

#include <string>
#include <vector>

#include "mesh/tet_mesh.h"

namespace rhexis::mesh {

enum class DefectKind {
  inverted_tet,
  flat_tet,
  duplicate_tet,
  repeated_node,
  unconnected_tet,
  non_manifold_face,
  unused_node,
  bad_index,
  not_finite
};

struct Defect {
  DefectKind kind = DefectKind::inverted_tet;
  TetId tet;         ///< invalid when the defect is of a node
  NodeId node;       ///< invalid when the defect is of a tet or face
  std::string what;  ///< one line: "tet 17 is flat (volume 1.2e-19 m^3, height over longest edge 3e-10)"
};

/// A tet is flat when its smallest height is below this fraction of its longest edge.
inline constexpr double kFlatTet = 1e-6;

/// All defects, ordered by kind, then index. `unconnected_tet`: tets that share no face-connected path with the largest
/// face-connected piece (one defect a piece, naming its first tet and its size). `unused_node` is a defect only of
/// a mesh made by hand: readers leave such nodes in and models hold them fixed.
[[nodiscard]] std::vector<Defect> find_defects(const TetMesh& mesh);

/// Swaps two vertices of every tet whose signed volume is negative. Returns how many were turned.
std::size_t orient_tets(TetMesh& mesh);

}  // namespace rhexis::mesh
