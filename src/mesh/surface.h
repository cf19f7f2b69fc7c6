#pragma once

/// Faces of a tet mesh: which tets meet, and where the body ends.

#include <vector>

#include "mesh/tet_mesh.h"

namespace rhexis::mesh {

/// A face that two tets share. `first.tet < second.tet`.
struct InteriorFace {
  TetFace first;
  TetFace second;
};

struct FaceTable {
  std::vector<InteriorFace> interior;  ///< ordered by (first.tet, first.vertex)
  std::vector<TetFace> boundary;       ///< ordered; faces that one tet has
  std::vector<TetFace> non_manifold;   ///< ordered; faces that three or more tets claim
};

/// O(n log n) by sorting; deterministic.
[[nodiscard]] FaceTable find_faces(const TetMesh& mesh);

/// Reference area, m^2.
[[nodiscard]] double face_area(const TetMesh& mesh, TetFace face);

}  // namespace rhexis::mesh
