#pragma once

/// What has become of the tets of a torn body.

#include <algorithm>
#include <limits>

#include "mesh/quality.h"
#include "mesh/torn_mesh.h"

namespace rhexis::test {

/// The least volume of a tet in the solve, relative to its reference: not above zero, it is inside out. `u`: of every
/// node, m.
inline double least_volume_ratio(const mesh::TornMesh& body, const VectorX& u) {
  mesh::TetMesh moved = body.mesh();
  for (std::size_t i = 0; i < moved.nodes.size(); ++i) moved.nodes[i] += u.segment<3>(3 * static_cast<Eigen::Index>(i));
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t t = 0; t < moved.tets.size(); ++t) {
    if (!body.is_solved(TetId(t))) continue;
    least = std::min(least, mesh::signed_volume(moved, TetId(t)) / mesh::signed_volume(body.mesh(), TetId(t)));
  }
  return least;
}

}  // namespace rhexis::test
