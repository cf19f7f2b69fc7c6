// The numerical inf-sup test: the smallest eigenvalue s of
//     (B^T A^-1 B + K_S) q = s (M / mu) q
// under refinement, in a clamped cube and one with a free side. It falls like h for P1/P0 as it stands and stays for
// beta = auto. The part M/kappa of the tangent is left out: it would hide the fall. A fixed beta cannot keep it: the
// classical jump term is h / mu, ours is beta h / kappa.

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "mesh/generate.h"
#include "mesh/surface.h"
#include "model/make_model.h"
#include "model/stabilisation.h"
#include "tests/support/measured.h"

namespace rhexis {
namespace {

enum class Sides { all_held, one_free };

struct InfSup {
  double smallest = 0.0;
  int kernel = 0;  ///< eigenvalues at rounding: spurious pressures, the constant one not counted
};

InfSup inf_sup(const mesh::TetMesh& mesh, const material::MooneyRivlin& law, double beta, Sides sides) {
  model::ModelSettings settings;
  settings.kind = model::ModelKind::hyperelastic;
  settings.law = law;
  settings.beta = beta;
  const std::unique_ptr<model::Model> body = model::make_model(mesh, settings);
  const std::unique_ptr<model::Scratch> scratch = body->make_scratch();
  linalg::SaddleMatrix K = body->make_tangent();
  body->tangent(body->initial_state(), *scratch, K);

  std::vector<bool> held(3 * mesh.node_count(), false);
  for (const std::string side : {"-x", "+x", "-y", "+y", "-z", "+z"}) {
    if (sides == Sides::one_free && side == "+z") continue;
    for (const NodeId node : mesh.find_node_set(side)->nodes)
      for (std::size_t i = 0; i < 3; ++i) held[3 * node.index() + i] = true;
  }
  const linalg::FreeDofs free = linalg::make_free_dofs(held);
  const Eigen::Index n = free.count();
  const auto m = static_cast<Eigen::Index>(mesh.tet_count());

  // Dense, by products with unit vectors: slow and plain.
  Eigen::MatrixXd A(n, n), B(n, m), S(m, m);
  VectorX xu = VectorX::Zero(K.displacement_unknowns()), xp = VectorX::Zero(m), yu(xu.size()), yp(m);
  for (Eigen::Index j = 0; j < n; ++j) {
    xu.setZero();
    xu[free.dof[static_cast<std::size_t>(j)]] = 1.0;
    K.A.multiply(xu, yu);
    for (Eigen::Index i = 0; i < n; ++i) A(i, j) = yu[free.dof[static_cast<std::size_t>(i)]];
    K.B.multiply(xu, yp);
    B.row(j) = yp.transpose();
  }
  for (Eigen::Index j = 0; j < m; ++j) {
    xp.setZero();
    xp[j] = 1.0;
    K.C.multiply(xp, yp);
    S.col(j) = yp;
    S(j, j) -= mesh::signed_volume(mesh, TetId(static_cast<std::size_t>(j))) / law.kappa;  // leaves K_S
  }
  S += B.transpose() * A.ldlt().solve(B);

  VectorX mass(m);
  for (Eigen::Index t = 0; t < m; ++t)
    mass[t] = mesh::signed_volume(mesh, TetId(static_cast<std::size_t>(t))) / law.shear_modulus();
  const VectorX scale = mass.cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = scale.asDiagonal() * (0.5 * (S + S.transpose())) * scale.asDiagonal();
  const VectorX eigenvalues =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(scaled, Eigen::EigenvaluesOnly).eigenvalues();
  InfSup result;
  // With every side held a constant pressure does no work: one eigenvalue is zero whatever the element.
  for (Eigen::Index i = sides == Sides::all_held ? 1 : 0; i < m; ++i) {
    if (eigenvalues[i] < 1e-10) {
      ++result.kernel;
      continue;
    }
    result.smallest = eigenvalues[i];
    break;
  }
  if (result.kernel > 0) result.smallest = 0.0;
  return result;
}

mesh::TetMesh box(int cells) { return mesh::make_structured_box(Vec3::Constant(0.1), {cells, cells, cells}); }

class InfSupTest : public testing::TestWithParam<Sides> {};

TEST_P(InfSupTest, FallsWithoutStabilisation) {
  const material::MooneyRivlin law = material::to_mooney_rivlin({1e5, 0.499});
  const double coarse = inf_sup(box(2), law, 0.0, GetParam()).smallest;
  const double fine = inf_sup(box(6), law, 0.0, GetParam()).smallest;
  EXPECT_LT(fine, 0.5 * coarse + 1e-12);
}

TEST_P(InfSupTest, StaysWithAuto) {
  const material::MooneyRivlin law = material::to_mooney_rivlin({1e5, 0.499});
  std::vector<double> smallest;
  for (const int cells : {2, 4, 6}) {
    const mesh::TetMesh mesh = box(cells);
    smallest.push_back(inf_sup(mesh, law, model::auto_beta(law), GetParam()).smallest);
    test::measured("inf-sup, auto, {} cells a side: {:.3f}; beta = 0: {:.4f}", cells, smallest.back(),
                   inf_sup(mesh, law, 0.0, GetParam()).smallest);
  }
  for (const double value : smallest) EXPECT_GT(value, 0.05);
  // A factor 3 in h would take a falling eigenvalue to a third.
  EXPECT_GT(smallest.back(), 0.8 * smallest.front());
}

TEST_P(InfSupTest, AFixedBetaLosesToTheBulkModulus) {
  // beta h / kappa against h / mu: with kappa a thousand times larger, the same beta is a thousand times weaker.
  const double soft = inf_sup(box(4), material::to_mooney_rivlin({1e5, 0.49}), 1.0, GetParam()).smallest;
  const double stiff = inf_sup(box(4), material::to_mooney_rivlin({1e5, 0.49999}), 1.0, GetParam()).smallest;
  EXPECT_LT(stiff, 0.1 * soft);
}

INSTANTIATE_TEST_SUITE_P(Cube, InfSupTest, testing::Values(Sides::all_held, Sides::one_free),
                         [](const auto& tested) { return tested.param == Sides::all_held ? "AllHeld" : "OneFree"; });

}  // namespace
}  // namespace rhexis
