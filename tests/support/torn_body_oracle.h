#pragma once

/// A torn body of small strains solved the slow obvious way: all of it is assembled and factored, for one topology.

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "element/linear_tet.h"
#include "linalg/cholesky_factor.h"
#include "mesh/torn_mesh.h"
#include "response/elastic_elements.h"

namespace rhexis::test {

class TornBodyOracle {
 public:
  TornBodyOracle(const mesh::TornMesh& mesh, const response::ElasticBody& body)
      : nodes_(static_cast<std::int32_t>(mesh.mesh().node_count())) {
    const mesh::TetMesh& m = mesh.mesh();
    const auto dofs = static_cast<Eigen::Index>(3 * m.node_count());
    std::vector<std::int32_t> solved;
    std::vector<std::int32_t> connectivity;
    std::vector<bool> held(3 * m.node_count(), true);  // a node without a tet in the solve is out of it
    std::vector<bool> in_solve(m.node_count(), false);
    for (std::size_t t = 0; t < m.tet_count(); ++t) {
      if (!mesh.is_solved(TetId(t))) continue;
      solved.push_back(static_cast<std::int32_t>(t));
      for (const NodeId node : m.tets[t]) {
        connectivity.push_back(node.value());
        in_solve[node.index()] = true;
      }
    }
    for (std::size_t i = 0; i < held.size(); ++i) held[i] = !in_solve[i / 3];
    prescribed_ = VectorX::Zero(dofs);
    for (std::size_t i = 0; i < m.node_count(); ++i) {
      if (!in_solve[i]) continue;
      for (const model::PrescribedDof& support : body.supports) {
        if (support.dof / 3 != mesh.original(NodeId(i)).value()) continue;
        const std::size_t dof = 3 * i + static_cast<std::size_t>(support.dof % 3);
        held[dof] = true;
        prescribed_[static_cast<Eigen::Index>(dof)] = support.value;
      }
    }
    free_ = linalg::make_free_dofs(held);

    const auto pattern =
        std::make_shared<const linalg::BlockPattern>(linalg::make_block_pattern(nodes_, connectivity, 4));
    linalg::SymmetricBlockMatrix K(pattern);
    VectorX weight = VectorX::Zero(dofs);
    for (const std::int32_t t : solved) {
      Eigen::Matrix<double, 12, 12> K_e;
      const auto x = mesh::corners(m, TetId(t));
      element::small_strain_stiffness(body.elastic, element::make_linear_tet(x), K_e);
      const Vec3 quarter = body.density * mesh::signed_volume(m, TetId(t)) / 4.0 * body.gravity;
      for (int a = 0; a < 4; ++a) {
        const std::int32_t row = m.tet(TetId(t))[static_cast<std::size_t>(a)].value();
        weight.segment<3>(3 * Eigen::Index{row}) += quarter;
        for (int b = 0; b < 4; ++b) {
          const std::int32_t col = m.tet(TetId(t))[static_cast<std::size_t>(b)].value();
          if (col > row) continue;
          using Block = Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>;
          Block(K.values.data() + 9 * std::ptrdiff_t{pattern->find(row, col)}) += K_e.block<3, 3>(3 * a, 3 * b);
        }
      }
    }
    for (std::size_t i = 0; i < mesh.intact_node_count() && body.dead_force.size() > 0; ++i) {
      const auto at = static_cast<Eigen::Index>(3 * i);
      if (in_solve[i]) dead_part(weight, at) += body.dead_force.segment<3>(at);
    }
    VectorX taken(dofs);
    K.multiply(prescribed_, taken);
    load_ = weight - taken;
    for (Eigen::Index i = 0; i < dofs; ++i) {
      if (held[static_cast<std::size_t>(i)]) load_[i] = 0.0;
    }
    is_stable_ = factor_.analyse(*pattern, free_) == linalg::CholeskyOutcome::ok &&
                 factor_.factor(K.values) == linalg::CholeskyOutcome::ok && factor_.smallest_pivot() > 1e-11;
    if (!is_stable_) return;
    rest_ = VectorX::Zero(dofs);
    factor_.solve(load_, rest_);
    // Potential energy, written out with all dofs.
    const VectorX u = rest_ + prescribed_;
    VectorX Ku(dofs);
    K.multiply(u, Ku);
    VectorX dead = VectorX::Zero(dofs);
    energy_ = 0.5 * u.dot(Ku) - weight.dot(u) + held_work(mesh, body, in_solve);
  }

  [[nodiscard]] bool is_stable() const { return is_stable_; }
  /// Of the nodes, 3 per node squared.
  [[nodiscard]] Eigen::MatrixXd compliance(const std::vector<NodeId>& nodes) {
    const auto columns = static_cast<Eigen::Index>(3 * nodes.size());
    Eigen::MatrixXd out = Eigen::MatrixXd::Zero(columns, columns);
    for (Eigen::Index j = 0; j < columns; ++j) {
      VectorX force = VectorX::Zero(columns);
      force[j] = 1.0;
      out.col(j) = at(nodes, by_forces(nodes, force));
    }
    return out;
  }
  /// Of all nodes, by the loads and by forces on some nodes; with what is prescribed.
  [[nodiscard]] VectorX displacement(const std::vector<NodeId>& nodes, const VectorX& force) {
    return rest_ + prescribed_ + by_forces(nodes, force);
  }
  [[nodiscard]] VectorX rest(const std::vector<NodeId>& nodes) const { return at(nodes, rest_ + prescribed_); }
  /// 1/2 u K u - (dead loads) u at rest, J.
  [[nodiscard]] double energy_at_rest() const { return energy_; }
  [[nodiscard]] static VectorX at(const std::vector<NodeId>& nodes, const VectorX& u) {
    VectorX out(static_cast<Eigen::Index>(3 * nodes.size()));
    for (std::size_t i = 0; i < nodes.size(); ++i)
      out.segment<3>(static_cast<Eigen::Index>(3 * i)) = u.segment<3>(3 * Eigen::Index{nodes[i].value()});
    return out;
  }

 private:
  static Eigen::Ref<Vec3> dead_part(VectorX& weight, Eigen::Index at) { return weight.segment<3>(at); }
  /// Dead forces on prescribed dofs do work that never changes; it is left out on both sides.
  static double held_work(const mesh::TornMesh&, const response::ElasticBody& body, const std::vector<bool>& in_solve) {
    double sum = 0.0;
    for (const model::PrescribedDof& support : body.supports) {
      if (body.dead_force.size() > 0 && in_solve[static_cast<std::size_t>(support.dof / 3)])
        sum += body.dead_force[support.dof] * support.value;
    }
    return sum;
  }
  [[nodiscard]] VectorX by_forces(const std::vector<NodeId>& nodes, const VectorX& force) {
    VectorX b = VectorX::Zero(load_.size());
    for (std::size_t i = 0; i < nodes.size(); ++i)
      b.segment<3>(3 * Eigen::Index{nodes[i].value()}) += force.segment<3>(static_cast<Eigen::Index>(3 * i));
    VectorX u = VectorX::Zero(load_.size());
    factor_.solve(b, u);
    return u;
  }

  std::int32_t nodes_ = 0;
  bool is_stable_ = false;
  linalg::FreeDofs free_;
  linalg::CholeskyFactor factor_;
  VectorX prescribed_, load_, rest_;
  double energy_ = 0.0;
};

}  // namespace rhexis::test
