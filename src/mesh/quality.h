#pragma once

#include "mesh/tet_mesh.h"

namespace rhexis::mesh {

struct Range {
  double min = 0.0;
  double mean = 0.0;
  double max = 0.0;
};

struct Quality {
  Range dihedral;      ///< degrees, over all six angles of all tets
  Range radius_ratio;  ///< 3 r_in / r_circ: 1 for a regular tet, 0 for a flat one
  Range edge;          ///< m, over distinct edges
  Range volume;        ///< m^3, over tets
};
[[nodiscard]] Quality measure_quality(const TetMesh& mesh);

/// 3 r_in / r_circ of one tet, in [0, 1].
[[nodiscard]] double radius_ratio(const std::array<Vec3, 4>& x);

/// The thickness of the body as a length: the largest diameter of a sphere inside it, estimated as twice the largest
/// distance from an interior point (nodes and tet centroids) to the boundary surface, m.
[[nodiscard]] double thickness(const TetMesh& mesh);

}  // namespace rhexis::mesh
