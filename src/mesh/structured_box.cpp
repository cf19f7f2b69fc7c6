#include <Eigen/Dense>

#include "base/check.h"
#include "mesh/body_request.h"
#include "mesh/generate.h"
#include "mesh/generated_sets.h"

namespace rhexis::mesh {
namespace {

using Cell = std::array<int, 3>;

/// The five tets of one cell. Face diagonals join the corners whose index sum over the whole lattice is even, so that
/// two neighbours agree on theirs: one tet of the four even corners, and one at each odd corner with its three (even)
/// neighbours.
template <class NodeAt>
void add_cell(TetMesh& mesh, const Cell& cell, const NodeAt& node_at) {
  Tet middle;
  std::size_t filled = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Cell at{cell[0] + (corner & 1), cell[1] + (corner >> 1 & 1), cell[2] + (corner >> 2 & 1)};
    if ((at[0] + at[1] + at[2]) % 2 == 0) {
      middle[filled++] = node_at(at);
      continue;
    }
    Tet tet{node_at(at)};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      Cell neighbour = at;
      neighbour[axis] += at[axis] == cell[axis] ? 1 : -1;
      tet[axis + 1] = node_at(neighbour);
    }
    add_oriented_tet(mesh, tet);
  }
  add_oriented_tet(mesh, middle);
}

}  // namespace

TetMesh make_structured_box(const Vec3& size, const std::array<int, 3>& cells) {
  RHEXIS_CHECK(size.allFinite() && size.minCoeff() > 0.0, "a box needs positive sides");
  RHEXIS_CHECK(cells[0] > 0 && cells[1] > 0 && cells[2] > 0, "a box needs at least one cell in each direction");

  TetMesh mesh;
  for (int k = 0; k <= cells[2]; ++k)
    for (int j = 0; j <= cells[1]; ++j)
      for (int i = 0; i <= cells[0]; ++i)
        mesh.nodes.emplace_back(part_of(size[0], i, cells[0]), part_of(size[1], j, cells[1]),
                                part_of(size[2], k, cells[2]));
  const auto node_at = [&](const Cell& at) {
    return NodeId((at[2] * (cells[1] + 1) + at[1]) * (cells[0] + 1) + at[0]);
  };

  mesh.tets.reserve(5 * static_cast<std::size_t>(cells[0]) * static_cast<std::size_t>(cells[1]) *
                    static_cast<std::size_t>(cells[2]));
  for (int k = 0; k < cells[2]; ++k)
    for (int j = 0; j < cells[1]; ++j)
      for (int i = 0; i < cells[0]; ++i) add_cell(mesh, {i, j, k}, node_at);
  add_box_sides(mesh, size);
  return mesh;
}

}  // namespace rhexis::mesh
