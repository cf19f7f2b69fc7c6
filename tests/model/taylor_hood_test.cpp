#include "model/taylor_hood.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Dense>

#include "base/parallel.h"
#include "material/mooney_rivlin.h"
#include "tests/model/differences.h"
#include "tests/model/small_newton.h"
#include "tests/model/test_bodies.h"

namespace rhexis::model {
namespace {

using test::kuhn_box;
using test::Noise;

const material::MooneyRivlin kLaw{9.0e3, 7.0e3, 1.6e6};

std::unique_ptr<Model> taylor_hood(const mesh::TetMesh& mesh, const material::MooneyRivlin& law = kLaw) {
  ModelSettings settings;
  settings.kind = ModelKind::taylor_hood;
  settings.law = law;
  settings.initial_lambda = 300.0;
  return make_taylor_hood(mesh, settings);
}

struct Case {
  explicit Case(mesh::TetMesh of, const material::MooneyRivlin& law = kLaw)
      : mesh(std::move(of)),
        model(taylor_hood(mesh, law)),
        state(model->initial_state()),
        scratch(model->make_scratch()),
        out{VectorX(state.u.size()), VectorX(state.lambda.size())},
        K(model->make_tangent()) {}

  /// Residual in one vector, forces first.
  VectorX residual(const State& at) {
    model->residual(at, *scratch, out);
    VectorX all(out.u.size() + out.lambda.size());
    all << out.u, out.lambda;
    return all;
  }
  [[nodiscard]] State moved(const State& from, double s, const State& along) const {
    return {from.u + s * along.u, from.lambda + s * along.lambda};
  }
  [[nodiscard]] VectorX affine(const Mat3& F) const {
    VectorX u(state.u.size());
    for (std::size_t i = 0; i < model->space().node_count(); ++i) {
      u.segment<3>(3 * static_cast<Eigen::Index>(i)) = (F - Mat3::Identity()) * model->space().nodes[i];
    }
    return u;
  }
  [[nodiscard]] State noisy(std::uint32_t seed, double u_size, double lambda_size) const {
    Noise noise(seed);
    VectorX u = noise.vector(state.u.size(), u_size);
    return {std::move(u), noise.vector(state.lambda.size(), lambda_size)};
  }

  mesh::TetMesh mesh;
  std::unique_ptr<Model> model;
  State state;
  std::unique_ptr<Scratch> scratch;
  Residual out;
  linalg::SaddleMatrix K;
};

/// A shear and stretch of some tens of percent.
Mat3 some_deformation() {
  Mat3 F;
  F << 1.2, 0.3, -0.1, 0.05, 0.9, 0.2, 0.1, -0.15, 1.05;
  return F;
}

TEST(TaylorHood, SaysWhatItIs) {
  Case c(kuhn_box({1.0, 1.0, 1.0}, {2, 1, 1}));
  EXPECT_EQ(c.model->name(), "taylor-hood");
  EXPECT_EQ(c.model->space().order, 2);
  EXPECT_EQ(c.model->pressure_unknowns(), static_cast<std::int32_t>(c.mesh.node_count()));
  EXPECT_FALSE(c.model->allows_inversion());
  EXPECT_FALSE(c.model->is_linear());
  EXPECT_TRUE(c.state.u.isZero(0.0));
  EXPECT_TRUE((c.state.lambda.array() == 300.0).all());
  EXPECT_GT(c.model->memory_bytes(), c.mesh.tet_count() * 500);
}

class TaylorHoodLaws : public testing::TestWithParam<double> {};  // c2
INSTANTIATE_TEST_SUITE_P(, TaylorHoodLaws, testing::Values(0.0, 7.0e3),
                         [](const auto& p) { return p.param == 0.0 ? "NeoHookean" : "MooneyRivlin"; });

TEST_P(TaylorHoodLaws, ResidualIsTheGradientOfTheLagrangian) {
  Case c(kuhn_box({1.0, 1.2, 0.8}, {2, 2, 2}, 0.2), {9.0e3, GetParam(), 1.6e6});
  const State at = c.noisy(1, 0.02, 2.0e3);
  const VectorX R = c.residual(at);
  // Directions of u and of lambda apart, so that neither drowns the other.
  for (const bool pressures : {false, true}) {
    State along = c.noisy(2, pressures ? 0.0 : 1.0, pressures ? 1.0 : 0.0);
    VectorX v(R.size());
    v << along.u, along.lambda;
    const double h = pressures ? 1.0e3 : 4e-4;
    const double slope = test::scalar_derivative([&](double s) { return c.model->energy(c.moved(at, s, along)); }, h);
    const double size = (pressures ? c.out.lambda : c.out.u).norm() * v.norm();
    ASSERT_GT(std::abs(slope), 1e-3 * size);
    EXPECT_NEAR(R.dot(v), slope, 1e-9 * size);
  }
}

TEST_P(TaylorHoodLaws, TangentIsTheDerivativeOfTheResidual) {
  Case c(kuhn_box({1.0, 1.2, 0.8}, {2, 2, 2}, 0.2), {9.0e3, GetParam(), 1.6e6});
  const State at = c.noisy(1, 0.02, 2.0e3);
  c.model->tangent(at, *c.scratch, c.K);
  for (const bool pressures : {false, true}) {
    const State along = c.noisy(2, pressures ? 0.0 : 1.0, pressures ? 1.0 : 0.0);
    const double h = pressures ? 1.0e3 : 4e-4;
    const VectorX slope = test::derivative([&](double s) { return c.residual(c.moved(at, s, along)); }, h);
    VectorX Ku(c.state.u.size());
    VectorX Kp(c.state.lambda.size());
    c.K.multiply(along.u, along.lambda, Ku, Kp);
    EXPECT_LT((Ku - slope.head(Ku.size())).norm(), 1e-9 * Ku.norm());
    EXPECT_LT((Kp - slope.tail(Kp.size())).norm(), 1e-9 * Kp.norm());
  }
}

TEST(TaylorHood, TangentOverwritesWhatWasThere) {
  Case c(kuhn_box({1.0, 1.0, 1.0}, {1, 1, 2}));
  const State at = c.noisy(3, 0.02, 1.0e3);
  c.model->tangent(at, *c.scratch, c.K);
  const linalg::SaddleMatrix first = c.K;
  c.K.skew.emplace().values.assign(c.K.A.values.size(), 1.0);
  c.model->tangent(at, *c.scratch, c.K);
  EXPECT_EQ(c.K.A.values, first.A.values);
  EXPECT_EQ(c.K.B.values, first.B.values);
  EXPECT_EQ(c.K.C.values, first.C.values);
  EXPECT_FALSE(c.K.skew.has_value());
}

TEST(TaylorHood, IsBlindToRigidMotions) {
  Case c(kuhn_box({1.0, 1.0, 1.0}, {2, 2, 2}, 0.2));
  const State at = c.noisy(4, 0.02, 1.0e3);
  const Mat3 R = Eigen::AngleAxisd(2.0, Vec3(1.0, 2.0, -0.5).normalized()).toRotationMatrix();
  State turned = at;
  for (std::size_t i = 0; i < c.model->space().node_count(); ++i) {
    const auto k = 3 * static_cast<Eigen::Index>(i);
    const Vec3& X = c.model->space().nodes[i];
    turned.u.segment<3>(k) = R * (X + at.u.segment<3>(k)) + Vec3(0.3, -0.2, 0.1) - X;
  }
  const VectorX before = c.residual(at);
  VectorX difference = c.residual(turned);
  for (Eigen::Index k = 0; k < at.u.size(); k += 3) difference.segment<3>(k) -= R * before.segment<3>(k);
  difference.tail(at.lambda.size()) -= before.tail(at.lambda.size());
  EXPECT_LT(difference.head(at.u.size()).norm(), 1e-12 * before.head(at.u.size()).norm());
  EXPECT_LT(difference.tail(at.lambda.size()).norm(), 1e-12 * before.tail(at.lambda.size()).norm());
  EXPECT_NEAR(c.model->energy(turned), c.model->energy(at), 1e-12 * std::abs(c.model->energy(at)));
}

// Uniform deformation and lambda: inner nodes are in balance, the constraint is the same everywhere, and the stress is
// the law's, whose own mean is nothing.
TEST(TaylorHood, UniformStatesAreExact) {
  Case c(kuhn_box({1.0, 1.2, 0.8}, {3, 3, 3}, 0.2));
  const Mat3 F = some_deformation();
  const double J = F.determinant();
  const double lambda = 5.0e4;
  const State at{c.affine(F), VectorX::Constant(c.state.lambda.size(), lambda)};
  c.residual(at);
  double inner = 0.0;
  const DisplacementSpace& space = c.model->space();
  const Vec3 size(1.0, 1.2, 0.8);
  for (std::size_t i = 0; i < space.node_count(); ++i) {
    const Vec3& X = space.nodes[i];
    if ((X.array() > 1e-9).all() && (X.array() < size.array() - 1e-9).all()) {
      inner = std::max(inner, c.out.u.segment<3>(3 * static_cast<Eigen::Index>(i)).norm());
    }
  }
  EXPECT_LT(inner, 1e-13 * c.out.u.cwiseAbs().maxCoeff() * 100.0);
  EXPECT_NEAR(c.out.lambda.sum(), size.prod() * (J - 1.0 - lambda / kLaw.kappa), 1e-14);
  EXPECT_NEAR(c.model->volume_change_norm(at) / c.out.lambda.norm(), (J - 1.0) / (J - 1.0 - lambda / kLaw.kappa),
              1e-11);

  // sigma = 2/J dev(a1 b + a2 (I1 b - b b)) + lambda I.
  const Mat3 b = F * F.transpose();
  const double r = std::pow(J, -2.0 / 3.0);
  Mat3 expected = 2.0 / J * (kLaw.c1 * r * b + kLaw.c2 * r * r * (b.trace() * b - b * b));
  expected -= expected.trace() / 3.0 * Mat3::Identity();
  expected += lambda * Mat3::Identity();
  const TetFields fields = c.model->fields(at);
  for (std::size_t t = 0; t < c.mesh.tet_count(); ++t) {
    const double* s = &fields.stress[6 * t];
    Mat3 stress;
    stress << s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2];
    EXPECT_LT((stress - expected).norm(), 1e-12 * expected.norm());
    EXPECT_NEAR(fields.J[t], J, 1e-13);
    EXPECT_NEAR(fields.lambda[t], lambda, 1e-10);
    EXPECT_NEAR(c.scratch->J[static_cast<Eigen::Index>(t)], J, 1e-13);
  }
}

/// All components of the nodes that `where` picks; values F X - X.
std::vector<PrescribedDof> hold_affine(const Case& c, const Mat3& F, const std::vector<NodeId>& where) {
  const VectorX u = c.affine(F);
  std::vector<PrescribedDof> supports;
  for (const std::int32_t node : nodes_of_set(c.model->space(), where)) {
    for (std::int32_t k = 3 * node; k < 3 * node + 3; ++k) supports.push_back({k, u[k]});
  }
  return supports;
}

// The patch test: supports of a uniform deformation on the whole surface give that deformation inside, and lambda is
// kappa (J - 1) everywhere.
TEST(TaylorHood, PassesThePatchTest) {
  Case c(kuhn_box({1.0, 1.2, 0.8}, {3, 3, 3}, 0.2));
  Mat3 F = Mat3::Identity() + 0.3 * (some_deformation() - Mat3::Identity());
  const double J = F.determinant();
  std::vector<NodeId> surface;
  const Vec3 size(1.0, 1.2, 0.8);
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {0.0, size[axis]}) {
      const std::vector<NodeId> nodes = test::nodes_on_plane(c.mesh, axis, side);
      surface.insert(surface.end(), nodes.begin(), nodes.end());
    }
  }
  Loading loading;
  loading.supports = hold_affine(c, F, surface);
  // nodes_of_set takes edges through the body whose ends are both on the surface, too; they are held where they go.
  ASSERT_LT(loading.supports.size() + 200, static_cast<std::size_t>(c.state.u.size()));
  State state = c.state;
  const int iterations = test::solve_small(*c.model, loading, 1.0, 1e-12, state);
  EXPECT_GE(iterations, 2);
  const VectorX expected = c.affine(F);
  EXPECT_LT((state.u - expected).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LT((state.lambda.array() - kLaw.kappa * (J - 1.0)).abs().maxCoeff(), 1e-9 * kLaw.kappa);
}

TEST(TaylorHood, ReportsInversionAndStaysFinite) {
  Case c(kuhn_box({1.0, 1.0, 1.0}, {2, 2, 2}));
  State at = c.state;
  const auto middle = static_cast<Eigen::Index>((3 * 1 + 1) * 3 + 1);  // the node in the centre
  at.u.segment<3>(3 * middle) = Vec3(0.9, 0.0, 0.0);
  const VectorX R = c.residual(at);
  const Evaluation evaluation = c.model->residual(at, *c.scratch, c.out);
  EXPECT_TRUE(evaluation.finite);
  EXPECT_GT(evaluation.inverted_tets, 0);
  EXPECT_LT(evaluation.inverted_tets, static_cast<int>(c.mesh.tet_count()));
  EXPECT_LT(evaluation.min_J, 0.0);
  EXPECT_EQ(evaluation.min_J, c.scratch->J[evaluation.worst_tet.value()]);
  EXPECT_EQ(evaluation.min_J, c.scratch->J.minCoeff());
  EXPECT_TRUE(R.allFinite());
  EXPECT_EQ(c.model->energy(at), std::numeric_limits<double>::infinity());
  EXPECT_EQ(c.model->tangent(at, *c.scratch, c.K).inverted_tets, evaluation.inverted_tets);
  const TetFields fields = c.model->fields(at);
  EXPECT_TRUE(std::all_of(fields.stress.begin(), fields.stress.end(), [](double s) { return std::isfinite(s); }));
}

TEST(TaylorHood, NamesTheFirstTetThatIsNotFinite) {
  Case c(kuhn_box({1.0, 1.0, 1.0}, {2, 2, 2}));
  const std::size_t last = c.mesh.node_count() - 1;
  const auto has_last = [&](const mesh::Tet& tet) {
    return std::find(tet.begin(), tet.end(), NodeId(last)) != tet.end();
  };
  const auto first = std::find_if(c.mesh.tets.begin(), c.mesh.tets.end(), has_last) - c.mesh.tets.begin();
  for (const bool pressure : {false, true}) {
    State at = c.state;
    (pressure ? at.lambda[static_cast<Eigen::Index>(last)] : at.u[3 * static_cast<Eigen::Index>(last)]) =
        std::numeric_limits<double>::quiet_NaN();
    const Evaluation residual = c.model->residual(at, *c.scratch, c.out);
    EXPECT_FALSE(residual.finite);
    EXPECT_EQ(residual.worst_tet, TetId(static_cast<std::size_t>(first)));
    EXPECT_FALSE(c.model->tangent(at, *c.scratch, c.K).finite);
  }
}

TEST(TaylorHood, PreconditionerIsTheStrainEnergyAndTheScaledMass) {
  Case c(kuhn_box({1.0, 1.2, 0.8}, {2, 2, 2}, 0.2));
  const linalg::BlockPreconditioner blocks = c.model->preconditioner();
  const Mat3 H = some_deformation() - Mat3::Identity();
  const Mat3 eps = 0.5 * (H + H.transpose());
  const VectorX u = c.affine(some_deformation());
  VectorX Au(u.size());
  blocks.A0.multiply(u, Au);
  const double volume = 1.0 * 1.2 * 0.8;
  const double mu = kLaw.shear_modulus();
  EXPECT_NEAR(u.dot(Au), 2.0 * mu * volume * eps.squaredNorm(), 1e-12 * mu);
  const VectorX ones = VectorX::Ones(c.state.lambda.size());
  VectorX Sp(ones.size());
  blocks.S0.multiply(ones, Sp);
  EXPECT_NEAR(ones.dot(Sp), volume * (1.0 / mu + 1.0 / kLaw.kappa), 1e-14 * volume / mu * 10.0);
  c.model->tangent(c.state, *c.scratch, c.K);
  c.K.C.multiply(ones, Sp);
  EXPECT_NEAR(ones.dot(Sp), volume / kLaw.kappa, 1e-14 * volume / kLaw.kappa * 10.0);
}

// The inf-sup condition, and that S0 stands in for the Schur complement: on meshes of different size and shape, clamped
// at one side, the eigenvalues of B^T A0^-1 B + C against S0 keep away from zero.
TEST(TaylorHood, PreconditionerBoundsTheSchurComplement) {
  for (const int n : {1, 2}) {
    Case c(kuhn_box({1.0, 1.0, 2.0}, {n, n, 2 * n}, 0.2));
    const linalg::BlockPreconditioner blocks = c.model->preconditioner();
    c.model->tangent(c.state, *c.scratch, c.K);
    linalg::SaddleMatrix K = c.K;
    K.A = blocks.A0;
    Eigen::MatrixXd full = test::to_sparse(K);
    const Eigen::Index dofs = c.state.u.size();
    const Eigen::Index m = c.state.lambda.size();
    Loading loading;
    for (const PrescribedDof& s : hold_affine(c, Mat3::Identity(), test::nodes_on_plane(c.mesh, 2, 0.0))) {
      full.row(s.dof).setZero();
      full.col(s.dof).setZero();
      full(s.dof, s.dof) = 1.0;
    }
    const Eigen::LLT<Eigen::MatrixXd> A(full.topLeftCorner(dofs, dofs));
    ASSERT_EQ(A.info(), Eigen::Success);
    const Eigen::MatrixXd B = full.topRightCorner(dofs, m);
    const Eigen::MatrixXd schur = B.transpose() * A.solve(B) - full.bottomRightCorner(m, m);
    K.C = blocks.S0;
    const Eigen::MatrixXd S0 = -Eigen::MatrixXd(test::to_sparse(K)).bottomRightCorner(m, m);
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> eigen(schur, S0);
    EXPECT_GT(eigen.eigenvalues().minCoeff(), 0.1);
    EXPECT_LT(eigen.eigenvalues().maxCoeff(), 1.5);  // (div u)^2 <= 3 eps:eps
  }
}

TEST(TaylorHood, ToleratesAVertexWithoutATet) {
  mesh::TetMesh mesh = kuhn_box({1.0, 1.0, 1.0}, {1, 1, 1});
  mesh.nodes.push_back(Vec3(5.0, 5.0, 5.0));
  Case c(mesh);
  EXPECT_EQ(c.state.lambda[8], 0.0);
  const VectorX R = c.residual(c.state);
  EXPECT_TRUE(R.allFinite());
  EXPECT_EQ(R[R.size() - 1], 0.0);
  c.model->tangent(c.state, *c.scratch, c.K);
  const Eigen::MatrixXd C = -Eigen::MatrixXd(test::to_sparse(c.K)).bottomRightCorner(9, 9);
  EXPECT_EQ(Eigen::LLT<Eigen::MatrixXd>(C).info(), Eigen::Success);
}

TEST(TaylorHood, GivesTheSameBitsOnAnyNumberOfThreads) {
  Case c(kuhn_box({1.0, 1.0, 1.0}, {6, 6, 6}, 0.2));
  const State at = c.noisy(5, 0.005, 1.0e3);
  const int threads = thread_count();
  set_thread_count(1);
  const VectorX R = c.residual(at);
  c.model->tangent(at, *c.scratch, c.K);
  const linalg::SaddleMatrix K = c.K;
  const double energy = c.model->energy(at);
  set_thread_count(4);
  EXPECT_EQ(c.residual(at), R);
  c.model->tangent(at, *c.scratch, c.K);
  EXPECT_EQ(c.K.A.values, K.A.values);
  EXPECT_EQ(c.K.B.values, K.B.values);
  EXPECT_EQ(c.model->energy(at), energy);
  set_thread_count(threads);
}

}  // namespace
}  // namespace rhexis::model
