#pragma once

/// The whole body in small strains, assembled and factored at once: what local solves and energy releases are held
/// against, and where their boundary displacements come from.

#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "element/linear_tet.h"
#include "linalg/cholesky_factor.h"
#include "mesh/torn_mesh.h"

namespace rhexis::fracture::test {

struct WholeProblem {
  material::Elastic elastic;
  std::map<std::int32_t, double> given;  ///< dof -> m
  std::map<std::int32_t, double> force;  ///< dof -> N
  Vec3 body_force = Vec3::Zero();        ///< N/m^3

  void hold(const mesh::TetMesh& mesh, const std::string& set, int component, double value) {
    for (const NodeId node : mesh.find_node_set(set)->nodes) given[3 * node.value() + component] = value;
  }
};

/// m, 3 per node.
inline VectorX solve_whole(const mesh::TornMesh& body, const WholeProblem& problem) {
  const mesh::TetMesh& mesh = body.mesh();
  const auto dofs = 3 * static_cast<Eigen::Index>(mesh.node_count());
  std::vector<std::int32_t> connectivity;
  for (const mesh::Tet& tet : mesh.tets)
    for (const NodeId node : tet) connectivity.push_back(node.value());
  linalg::SymmetricBlockMatrix K(std::make_shared<const linalg::BlockPattern>(
      linalg::make_block_pattern(static_cast<std::int32_t>(mesh.node_count()), connectivity, 4)));
  VectorX rhs = VectorX::Zero(dofs);
  VectorX u = VectorX::Zero(dofs);
  std::vector<bool> held(static_cast<std::size_t>(dofs), false);
  for (const auto& [dof, value] : problem.given) {
    held[static_cast<std::size_t>(dof)] = true;
    u[dof] = value;
  }
  for (const auto& [dof, value] : problem.force) rhs[dof] += value;
  for (std::size_t node = 0; node < mesh.node_count(); ++node)
    if (!body.is_alive(NodeId(node)))
      for (std::size_t i = 0; i < 3; ++i) held[3 * node + i] = true;
  Eigen::Matrix<double, 12, 12> element;
  for (std::size_t t = 0; t < mesh.tet_count(); ++t) {
    if (!body.is_solved(TetId(t))) continue;
    const element::LinearTet shape = element::make_linear_tet(mesh::corners(mesh, TetId(t)));
    element::small_strain_stiffness(problem.elastic, shape, element);
    for (int a = 0; a < 4; ++a) {
      const std::int32_t row = mesh.tets[t][static_cast<std::size_t>(a)].value();
      rhs.segment<3>(3 * row) += 0.25 * shape.volume * problem.body_force;
      for (int b = 0; b < 4; ++b) {
        const std::int32_t column = mesh.tets[t][static_cast<std::size_t>(b)].value();
        rhs.segment<3>(3 * row) -= element.block<3, 3>(3 * a, 3 * b) * u.segment<3>(3 * column);
        if (row < column) continue;
        Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(K.values.data() + 9 * K.pattern->find(row, column)) +=
            element.block<3, 3>(3 * a, 3 * b);
      }
    }
  }
  linalg::CholeskyFactor factor(linalg::Ordering::metis);
  EXPECT_EQ(factor.analyse(*K.pattern, linalg::make_free_dofs(held)), linalg::CholeskyOutcome::ok);
  EXPECT_EQ(factor.factor(K.values), linalg::CholeskyOutcome::ok);
  VectorX free(dofs);
  factor.solve(rhs, free);
  return u + free;
}

}  // namespace rhexis::fracture::test
