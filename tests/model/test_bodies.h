#pragma once

/// Small bodies and numbers for the tests of this room.

#include <array>
#include <cmath>
#include <cstdint>
#include <random>

#include "base/vec.h"
#include "mesh/tet_mesh.h"

namespace rhexis::test {

/// Uniform in [-size, size]; the same numbers on every machine (std::uniform_real_distribution does not promise that).
class Noise {
 public:
  explicit Noise(std::uint32_t seed) : engine_(seed) {}
  double operator()(double size) { return size * (2.0 * static_cast<double>(engine_()) / 4294967295.0 - 1.0); }
  Vec3 vec3(double size) {
    const double x = (*this)(size);
    const double y = (*this)(size);
    return {x, y, (*this)(size)};
  }
  VectorX vector(Eigen::Index length, double size) {
    VectorX out(length);
    for (double& value : out) value = (*this)(size);
    return out;
  }

 private:
  std::mt19937 engine_;
};

/// A box [0, size] of cells of six tets each (Kuhn's), whose inner nodes are moved by up to `jitter` of a cell, so that
/// no two tets are alike; the sides stay plane.
inline mesh::TetMesh kuhn_box(const Vec3& size, const std::array<int, 3>& cells, double jitter = 0.0) {
  mesh::TetMesh mesh;
  Noise noise(7);
  const auto node_at = [&](int i, int j, int k) { return NodeId((k * (cells[1] + 1) + j) * (cells[0] + 1) + i); };
  for (int k = 0; k <= cells[2]; ++k) {
    for (int j = 0; j <= cells[1]; ++j) {
      for (int i = 0; i <= cells[0]; ++i) {
        Vec3 x;
        const std::array<int, 3> at{i, j, k};
        for (int c = 0; c < 3; ++c) {
          const auto n = static_cast<std::size_t>(c);
          const bool inside = at[n] > 0 && at[n] < cells[n];
          x[c] = size[c] * (at[n] + (inside ? noise(jitter) : 0.0)) / cells[n];
        }
        mesh.nodes.push_back(x);
      }
    }
  }
  constexpr std::array<std::array<int, 3>, 6> kOrders{
      {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {1, 0, 2}, {0, 2, 1}, {2, 1, 0}}};
  for (int k = 0; k < cells[2]; ++k) {
    for (int j = 0; j < cells[1]; ++j) {
      for (int i = 0; i < cells[0]; ++i) {
        for (std::size_t o = 0; o < 6; ++o) {
          std::array<int, 3> at{i, j, k};
          mesh::Tet tet;
          tet[0] = node_at(at[0], at[1], at[2]);
          for (std::size_t step = 0; step < 3; ++step) {
            ++at[static_cast<std::size_t>(kOrders[o][step])];
            tet[step + 1] = node_at(at[0], at[1], at[2]);
          }
          if (o >= 3) std::swap(tet[2], tet[3]);  // odd orders turn the tet inside out
          mesh.tets.push_back(tet);
        }
      }
    }
  }
  return mesh;
}

/// One tet without a right angle.
inline mesh::TetMesh one_tet() {
  mesh::TetMesh mesh;
  mesh.nodes = {Vec3(0.1, 0.0, -0.1), Vec3(1.1, 0.2, 0.1), Vec3(0.3, 0.9, 0.0), Vec3(0.2, 0.3, 1.2)};
  mesh.tets = {{NodeId(0), NodeId(1), NodeId(2), NodeId(3)}};
  return mesh;
}

/// Nodes whose coordinate `axis` is `value`, to a billionth.
inline std::vector<NodeId> nodes_on_plane(const mesh::TetMesh& mesh, int axis, double value) {
  std::vector<NodeId> nodes;
  for (std::size_t i = 0; i < mesh.node_count(); ++i) {
    if (std::abs(mesh.nodes[i][axis] - value) < 1e-9) nodes.push_back(NodeId(i));
  }
  return nodes;
}

}  // namespace rhexis::test
