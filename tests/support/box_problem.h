#pragma once

/// Small-strain elasticity of a box on P1 / P0 with pressure jumps, assembled the obvious way: the shape of system that
/// the models hand over, without the models. A = 2 mu eps:eps, B = div, C = M / kappa + beta / kappa jumps (section 1.2
/// of the specification); -x side held.

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "linalg/saddle_matrix.h"
#include "linalg/saddle_solver.h"
#include "mesh/tet_mesh.h"

namespace rhexis::linalg::test {

/// n[0] x n[1] x n[2] cubes of side `h`, six tets each.
inline mesh::TetMesh make_box(const std::array<int, 3>& n, double h) {
  mesh::TetMesh mesh;
  const auto node = [&](int i, int j, int k) {
    return NodeId(static_cast<std::int32_t>((k * (n[1] + 1) + j) * (n[0] + 1) + i));
  };
  for (int k = 0; k <= n[2]; ++k) {
    for (int j = 0; j <= n[1]; ++j) {
      for (int i = 0; i <= n[0]; ++i) mesh.nodes.emplace_back(i * h, j * h, k * h);
    }
  }
  constexpr std::array<std::array<int, 3>, 6> kPaths{
      {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};
  for (int k = 0; k < n[2]; ++k) {
    for (int j = 0; j < n[1]; ++j) {
      for (int i = 0; i < n[0]; ++i) {
        for (std::size_t path = 0; path < kPaths.size(); ++path) {  // from corner to corner, one axis at a time
          std::array<int, 3> at{i, j, k};
          mesh::Tet tet;
          tet[0] = node(i, j, k);
          for (std::size_t step = 0; step < 3; ++step) {
            ++at[static_cast<std::size_t>(kPaths[path][step])];
            tet[step + 1] = node(at[0], at[1], at[2]);
          }
          if (path >= 3) std::swap(tet[2], tet[3]);
          mesh.tets.push_back(tet);
        }
      }
    }
  }
  return mesh;
}

struct Material {
  double mu = 1.0;      ///< Pa
  double kappa = 25.0;  ///< Pa; the paper's ratio to mu
  double beta = 100.0;
};

struct BoxProblem {
  SaddleMatrix K;
  FreeDofs free;
  BlockPreconditioner blocks;              ///< A and M / mu + C
  SymmetricBlockMatrix displacement_only;  ///< A + kappa div div, the price that a corotated model pays
};

inline BoxProblem make_box_problem(const mesh::TetMesh& mesh, const Material& material) {
  BoxProblem problem;
  const auto nodes = static_cast<std::int32_t>(mesh.node_count());
  const auto m = static_cast<std::int32_t>(mesh.tet_count());
  std::vector<std::int32_t> connectivity;
  for (const mesh::Tet& tet : mesh.tets) {
    for (const NodeId id : tet) connectivity.push_back(id.value());
  }
  auto pattern = std::make_shared<const BlockPattern>(make_block_pattern(nodes, connectivity, 4));
  problem.K.A = SymmetricBlockMatrix(pattern);
  problem.displacement_only = SymmetricBlockMatrix(pattern);

  auto coupling = std::make_shared<CsrPattern>();
  coupling->row_start.push_back(0);
  for (std::int32_t t = 0; t < m; ++t) {
    std::array<std::int32_t, 4> sorted;
    std::copy_n(connectivity.begin() + 4 * t, 4, sorted.begin());
    std::sort(sorted.begin(), sorted.end());
    coupling->column.insert(coupling->column.end(), sorted.begin(), sorted.end());
    coupling->row_start.push_back(4 * (t + 1));
  }
  problem.K.B = CouplingMatrix(coupling);

  std::vector<double> volume(mesh.tet_count());
  for (std::int32_t t = 0; t < m; ++t) {
    const TetId id(t);
    const auto x = mesh::corners(mesh, id);
    Mat3 edges;
    edges << x[1] - x[0], x[2] - x[0], x[3] - x[0];
    const double v = volume[id.index()] = mesh::signed_volume(mesh, id);
    Eigen::Matrix<double, 3, 4> grad;
    grad.rightCols<3>() = edges.inverse().transpose();
    grad.col(0) = -grad.rightCols<3>().rowwise().sum();
    for (int a = 0; a < 4; ++a) {
      const std::int32_t row = connectivity[4 * id.index() + static_cast<std::size_t>(a)];
      for (int b = 0; b < 4; ++b) {
        const std::int32_t col = connectivity[4 * id.index() + static_cast<std::size_t>(b)];
        if (col > row) continue;
        const Mat3 shear =
            material.mu * v * (grad.col(a).dot(grad.col(b)) * Mat3::Identity() + grad.col(b) * grad.col(a).transpose());
        const Mat3 bulk = material.kappa * v * grad.col(a) * grad.col(b).transpose();
        using Block = Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>;
        const std::ptrdiff_t at = 9 * std::ptrdiff_t{pattern->find(row, col)};
        Block(problem.K.A.values.data() + at) += shear;
        Block(problem.displacement_only.values.data() + at) += shear + bulk;
      }
      for (std::int32_t k = 4 * t; k < 4 * t + 4; ++k) {
        if (coupling->column[static_cast<std::size_t>(k)] != row) continue;
        for (int c = 0; c < 3; ++c)
          problem.K.B.values[3 * static_cast<std::size_t>(k) + static_cast<std::size_t>(c)] = v * grad(c, a);
      }
    }
  }

  std::map<std::array<NodeId, 3>, std::int32_t> first_side;
  std::vector<std::map<std::int32_t, double>> jumps(mesh.tet_count());
  for (std::int32_t t = 0; t < m; ++t) {
    jumps[static_cast<std::size_t>(t)][t] += volume[static_cast<std::size_t>(t)] / material.kappa;
    for (std::int8_t face = 0; face < 4; ++face) {
      auto key = mesh::face_nodes(mesh, {TetId(t), face});
      const double area =
          0.5 * (mesh.node(key[1]) - mesh.node(key[0])).cross(mesh.node(key[2]) - mesh.node(key[0])).norm();
      std::sort(key.begin(), key.end());
      const auto [found, is_new] = first_side.emplace(key, t);
      if (is_new) continue;
      const std::int32_t other = found->second;
      const double weight = material.beta / material.kappa * area *
                            (mesh::longest_edge(mesh, TetId(t)) + mesh::longest_edge(mesh, TetId(other)));
      jumps[static_cast<std::size_t>(t)][t] += weight;
      jumps[static_cast<std::size_t>(other)][other] += weight;
      jumps[static_cast<std::size_t>(t)][other] -= weight;
    }
  }
  auto c_pattern = std::make_shared<CsrPattern>();
  c_pattern->row_start.push_back(0);
  std::vector<double> c_values;
  for (const auto& row : jumps) {
    for (const auto& [col, value] : row) {
      c_pattern->column.push_back(col);
      c_values.push_back(value);
    }
    c_pattern->row_start.push_back(static_cast<std::int32_t>(c_values.size()));
  }
  problem.K.C = SymmetricCsr(c_pattern);
  problem.K.C.values = c_values;
  problem.blocks.A0 = problem.K.A;
  problem.blocks.S0 = problem.K.C;
  for (std::size_t t = 0; t < volume.size(); ++t) {
    problem.blocks.S0.values[static_cast<std::size_t>(c_pattern->row_start[t + 1]) - 1] += volume[t] / material.mu;
  }

  std::vector<bool> held(3 * mesh.node_count());
  for (std::size_t i = 0; i < mesh.node_count(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) held[3 * i + c] = mesh.nodes[i].x() == 0.0;
  }
  problem.free = make_free_dofs(held);
  return problem;
}

}  // namespace rhexis::linalg::test
