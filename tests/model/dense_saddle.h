#pragma once

/// The tangent in the reference state, also as dense matrices: for tests of its spectra, slow and plain.

#include <Eigen/Dense>
#include <vector>

#include "linalg/saddle_matrix.h"
#include "mesh/tet_mesh.h"
#include "model/make_model.h"

namespace rhexis::test {

struct DenseSaddle {
  Eigen::MatrixXd A;        ///< free displacements, N/m
  Eigen::MatrixXd B;        ///< free displacements x tets, m^2
  Eigen::MatrixXd K_S;      ///< tets x tets, m^3/Pa, without M / kappa
  Eigen::VectorXd volumes;  ///< M, m^3
};

/// The hyperelastic tangent, sparse.
inline linalg::SaddleMatrix rest_tangent(const mesh::TetMesh& mesh, const material::MooneyRivlin& law, double beta) {
  model::ModelSettings settings;
  settings.kind = model::ModelKind::hyperelastic;
  settings.law = law;
  settings.beta = beta;
  const std::unique_ptr<model::Model> body = model::make_model(mesh, settings);
  const std::unique_ptr<model::Scratch> scratch = body->make_scratch();
  linalg::SaddleMatrix K = body->make_tangent();
  body->tangent(body->initial_state(), *scratch, K);
  return K;
}

/// `held` per dof, 3 * node + component.
inline DenseSaddle dense_saddle(const mesh::TetMesh& mesh, const material::MooneyRivlin& law, double beta,
                                const std::vector<bool>& held) {
  const linalg::SaddleMatrix K = rest_tangent(mesh, law, beta);
  const linalg::FreeDofs free = linalg::make_free_dofs(held);
  const Eigen::Index n = free.count();
  const auto m = static_cast<Eigen::Index>(mesh.tet_count());
  DenseSaddle dense{
      .A = Eigen::MatrixXd(n, n), .B = Eigen::MatrixXd(n, m), .K_S = Eigen::MatrixXd(m, m), .volumes = VectorX(m)};
  for (Eigen::Index t = 0; t < m; ++t) dense.volumes[t] = mesh::signed_volume(mesh, TetId(static_cast<std::size_t>(t)));

  // Columns by products with unit vectors.
  VectorX xu = VectorX::Zero(K.displacement_unknowns()), xp = VectorX::Zero(m), yu(xu.size()), yp(m);
  for (Eigen::Index j = 0; j < n; ++j) {
    xu.setZero();
    xu[free.dof[static_cast<std::size_t>(j)]] = 1.0;
    K.A.multiply(xu, yu);
    for (Eigen::Index i = 0; i < n; ++i) dense.A(i, j) = yu[free.dof[static_cast<std::size_t>(i)]];
    K.B.multiply(xu, yp);
    dense.B.row(j) = yp.transpose();
  }
  for (Eigen::Index j = 0; j < m; ++j) {
    xp.setZero();
    xp[j] = 1.0;
    K.C.multiply(xp, yp);
    dense.K_S.col(j) = yp;
    dense.K_S(j, j) -= dense.volumes[j] / law.kappa;
  }
  return dense;
}

}  // namespace rhexis::test
