#pragma once

/// Meshes for studies of the pressure stabilisation: grids of cells cut into six tets each, mirrored from cell to cell
/// so that no diagonal is preferred, inner nodes moved a little so that no mode lives from symmetry.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>

#include "mesh/tet_mesh.h"

namespace rhexis::test {

struct KuhnGrid {
  std::array<int, 3> cells{1, 1, 1};
  /// Every cell the mirror image of its neighbours; without it all diagonals run the same way.
  bool mirrored = true;
  /// The first direction closes on itself (needs an even number of cells); there is then no side to keep off.
  bool closed = false;
  /// Largest shift of a node along each direction, in cells. Nodes on the sides of the grid stay.
  Vec3 jitter = Vec3::Constant(0.15);
  /// Shift the nodes on the two sides of the third direction too (jitter[2] must be 0).
  bool jitter_last_sides = false;
  /// From grid coordinates (0 .. cells) to metres.
  std::function<Vec3(const Vec3&)> map = [](const Vec3& x) { return x; };
};

namespace detail {

/// Uniform in (-1, 1), the same on every machine.
class Shift {
 public:
  double next() {
    state_ = (1103515245 * state_ + 12345) % (std::uint64_t{1} << 31);
    return static_cast<double>(state_) / static_cast<double>(std::uint64_t{1} << 30) - 1.0;
  }

 private:
  std::uint64_t state_ = 1;
};

/// Which two vertices are swapped matters to model::refine, which chooses between diagonals of equal length by their
/// order.
inline void orient(mesh::TetMesh& mesh) {
  for (std::size_t t = 0; t < mesh.tet_count(); ++t)
    if (mesh::signed_volume(mesh, TetId(t)) < 0.0) std::swap(mesh.tets[t][1], mesh.tets[t][2]);
}

}  // namespace detail

/// Node (i, j, k) has the number (i (n1 + 1) + j) (n2 + 1) + k.
inline mesh::TetMesh make_kuhn_box(const KuhnGrid& grid) {
  mesh::TetMesh mesh;
  const auto [n0, n1, n2] = grid.cells;
  const int layers = grid.closed ? n0 : n0 + 1;
  detail::Shift shift;
  for (int i = 0; i < layers; ++i)
    for (int j = 0; j <= n1; ++j)
      for (int k = 0; k <= n2; ++k) {
        Vec3 at(i, j, k);
        const bool on_side = (!grid.closed && (i == 0 || i == n0)) || j == 0 || j == n1;
        if (!on_side && (grid.jitter_last_sides || (k > 0 && k < n2)))
          for (int c = 0; c < 3; ++c) at[c] += grid.jitter[c] * shift.next();
        mesh.nodes.push_back(grid.map(at));
      }

  constexpr std::array<std::array<int, 3>, 6> kOrders{
      {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};
  for (int i = 0; i < n0; ++i)
    for (int j = 0; j < n1; ++j)
      for (int k = 0; k < n2; ++k)
        for (const std::array<int, 3>& order : kOrders) {
          // A walk along the cell's edges from one corner to the opposite one.
          const std::array<int, 3> cell{i, j, k};
          std::array<int, 3> step{0, 0, 0};
          mesh::Tet tet;
          for (std::size_t corner = 0; corner < 4; ++corner) {
            if (corner > 0) step[static_cast<std::size_t>(order[corner - 1])] = 1;
            std::array<int, 3> at = cell;
            for (std::size_t c = 0; c < 3; ++c) at[c] += grid.mirrored && cell[c] % 2 == 1 ? 1 - step[c] : step[c];
            tet[corner] = NodeId(static_cast<std::size_t>(((at[0] % layers) * (n1 + 1) + at[1]) * (n2 + 1) + at[2]));
          }
          mesh.tets.push_back(tet);
        }
  detail::orient(mesh);
  return mesh;
}

}  // namespace rhexis::test
