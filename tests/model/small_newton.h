#pragma once

/// Equilibria of small bodies, by the plainest means: full Newton steps, the whole saddle matrix, one sparse LU. What
/// the solvers of the product are for is not needed here.

#include <cmath>
#include <vector>

#include <Eigen/Dense>
#include <Eigen/SparseLU>

#include "model/loading.h"
#include "model/model.h"

namespace rhexis::test {

/// The tangent with both triangles, displacement unknowns first.
inline Eigen::SparseMatrix<double> to_sparse(const linalg::SaddleMatrix& K) {
  std::vector<Eigen::Triplet<double>> entries;
  const auto add = [&](Eigen::Index row, Eigen::Index col, double value) {
    entries.emplace_back(static_cast<int>(row), static_cast<int>(col), value);
  };
  const linalg::BlockPattern& blocks = *K.A.pattern;
  for (Eigen::Index row = 0; row < blocks.rows(); ++row) {
    for (auto k = blocks.row_start[static_cast<std::size_t>(row)];
         k < blocks.row_start[static_cast<std::size_t>(row) + 1]; ++k) {
      const Eigen::Index col = blocks.column[static_cast<std::size_t>(k)];
      for (Eigen::Index i = 0; i < 9; ++i) {
        const double value = K.A.values[static_cast<std::size_t>(9 * k + i)];
        add(3 * row + i / 3, 3 * col + i % 3, value);
        if (row != col) add(3 * col + i % 3, 3 * row + i / 3, value);
      }
    }
  }
  const Eigen::Index n = K.displacement_unknowns();
  for (Eigen::Index row = 0; row < K.pressure_unknowns(); ++row) {
    const linalg::CsrPattern& B = *K.B.pattern;
    for (auto k = B.row_start[static_cast<std::size_t>(row)]; k < B.row_start[static_cast<std::size_t>(row) + 1]; ++k) {
      for (Eigen::Index i = 0; i < 3; ++i) {
        const Eigen::Index dof = 3 * B.column[static_cast<std::size_t>(k)] + i;
        add(n + row, dof, K.B.values[static_cast<std::size_t>(3 * k + i)]);
        add(dof, n + row, K.B.values[static_cast<std::size_t>(3 * k + i)]);
      }
    }
    const linalg::CsrPattern& C = *K.C.pattern;
    for (auto k = C.row_start[static_cast<std::size_t>(row)]; k < C.row_start[static_cast<std::size_t>(row) + 1]; ++k) {
      const Eigen::Index col = C.column[static_cast<std::size_t>(k)];
      add(n + row, n + col, -K.C.values[static_cast<std::size_t>(k)]);
      if (row != col) add(n + col, n + row, -K.C.values[static_cast<std::size_t>(k)]);
    }
  }
  Eigen::SparseMatrix<double> out(n + K.pressure_unknowns(), n + K.pressure_unknowns());
  out.setFromTriplets(entries.begin(), entries.end());
  return out;
}

/// Newton at load fraction t until |R| on the free unknowns falls below `tolerance` times max(|internal|, |external|)
/// for the forces and |V (J - 1)| for the constraint. Returns the number of iterations; -1 after 30, or on inversion.
inline int solve_small(const model::Model& model, const model::Loading& loading, double t, double tolerance,
                       model::State& state) {
  const auto scratch = model.make_scratch();
  linalg::SaddleMatrix K = model.make_tangent();
  model::Residual R{VectorX::Zero(state.u.size()), VectorX::Zero(state.lambda.size())};
  const Eigen::Index n = state.u.size();
  const Eigen::Index m = state.lambda.size();
  std::vector<bool> free(static_cast<std::size_t>(n + m), true);
  VectorX held = VectorX::Zero(n);
  for (const model::PrescribedDof& s : loading.supports) {
    free[static_cast<std::size_t>(s.dof)] = false;
    held[s.dof] = t * s.value - state.u[s.dof];
  }
  std::vector<Eigen::Index> unknown;
  for (Eigen::Index i = 0; i < n + m; ++i) {
    if (free[static_cast<std::size_t>(i)]) unknown.push_back(i);
  }
  Eigen::SparseMatrix<double> select(static_cast<Eigen::Index>(unknown.size()), n + m);
  for (std::size_t i = 0; i < unknown.size(); ++i) select.insert(static_cast<Eigen::Index>(i), unknown[i]) = 1.0;

  for (int iteration = 0; iteration <= 30; ++iteration) {
    const model::Evaluation evaluation = model.residual(state, *scratch, R);
    if (!evaluation.finite || (evaluation.inverted_tets > 0 && !model.allows_inversion())) return -1;
    VectorX external = VectorX::Zero(n);
    if (loading.dead_force.size() == n) external = t * loading.dead_force;
    for (const auto& load : loading.pressures) model::add_pressure_force(load, model.space(), state.u, t, external);
    const double scale = std::max(R.u.norm(), external.norm());
    VectorX rhs(n + m);
    rhs << external - R.u, -R.lambda;
    const VectorX free_rhs = select * rhs;
    const double u_norm = free_rhs.head(free_rhs.size() - m).norm();
    const bool constraint_met = m == 0 || R.lambda.norm() <= tolerance * model.volume_change_norm(state);
    if (held.isZero(0.0) && u_norm <= tolerance * scale && constraint_met) return iteration;

    model.tangent(state, *scratch, K);
    for (const auto& load : loading.pressures) model::subtract_pressure_stiffness(load, model.space(), state.u, t, K);
    const Eigen::SparseMatrix<double> full = to_sparse(K);
    VectorX step(n + m);
    step << held, VectorX::Zero(m);
    const Eigen::SparseMatrix<double> reduced = select * full * select.transpose();
    const Eigen::SparseLU<Eigen::SparseMatrix<double>> lu(reduced);
    step += select.transpose() * lu.solve(select * (rhs - full * step));
    state.u += step.head(n);
    state.lambda += step.tail(m);
    held.setZero();
  }
  return -1;
}

}  // namespace rhexis::test
