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

/// Share of the surface that may be thinner than what `thickness` returns. Below 1/3, so that a box gives its smallest
/// side exactly, and well above what corners, rims and cut ends take of a surface.
inline constexpr double kThicknessShare = 0.25;

/// The thickness of the body as a length, m. At each boundary triangle the body is as thick as the way from the
/// triangle's centre, along the inward normal, to where it leaves the body again; the thickness of the whole is the
/// length that a quarter of the surface, by area, stays below. A plate gives its height, a wall its thickness, a bar
/// its smallest side, a solid rod its diameter (less the faceting). 0 for a mesh without tets. Takes a mesh without
/// defects; O(n^(1/3)) tets are crossed per boundary triangle.
[[nodiscard]] double thickness(const TetMesh& mesh);

}  // namespace rhexis::mesh
