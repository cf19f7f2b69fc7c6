#pragma once

/// Bodies that need no file. Deterministic, well shaped, without a preferred diagonal, positively oriented.

#include <array>

#include "base/error.h"
#include "mesh/tet_mesh.h"

namespace rhexis::mesh {

/// Sets made: node and face sets "-x", "+x", "-y", "+y", "-z", "+z" (the six sides).
struct BoxShape {
  Vec3 size{1.0, 1.0, 1.0};  ///< m; the body fills [0, size]
};

/// A straight or bent tube along z. Sets made: "bottom" and "top" (the end cuts), "outer", and "inner" with a wall.
struct TubeShape {
  double radius = 0.005;  ///< outer, m
  double length = 0.04;   ///< along the centre line, m
  double wall = 0.0;      ///< m; 0: a solid rod
  double bend = 0.0;      ///< degrees by which the centre line turns, in the x-z plane, along its length
};

/// A plate: a box thin in z, meshed with well-shaped triangles in x, y and few layers through the thickness.
/// `nodes` is met within 2%, or the error says which counts near it can be had; as for tubes.
Expected<TetMesh> make_plate(const BoxShape& shape, int nodes);
/// A box whose tets are as regular as its sides allow; a cube is the one with equal sides. `nodes` is met exactly.
Expected<TetMesh> make_bar(const BoxShape& shape, int nodes);
/// The circles are inscribed polygons: nodes lie on them, facets a little inside.
Expected<TetMesh> make_tube(const TubeShape& shape, int nodes);

/// Structured box of n[0] x n[1] x n[2] cells, five tets a cell, alternating so that faces match: for
/// convergence studies, where each refinement halves h exactly.
[[nodiscard]] TetMesh make_structured_box(const Vec3& size, const std::array<int, 3>& cells);

}  // namespace rhexis::mesh
