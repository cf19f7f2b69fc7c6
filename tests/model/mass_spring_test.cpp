#include "model/mass_spring.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Dense>

#include "base/parallel.h"
#include "mesh/generate.h"
#include "tests/model/differences.h"
#include "tests/model/small_newton.h"
#include "tests/model/test_bodies.h"

namespace rhexis::model {
namespace {

using test::kuhn_box;
using test::Noise;

constexpr double kYoung = 1.0e5;

std::unique_ptr<Model> mass_spring(const mesh::TetMesh& mesh) {
  ModelSettings settings;
  settings.kind = ModelKind::mass_spring;
  settings.elastic = {kYoung, 0.45};
  return make_mass_spring(mesh, settings);
}

/// A model and a place for what it computes.
struct Case {
  explicit Case(mesh::TetMesh of)
      : mesh(std::move(of)), model(mass_spring(mesh)), state(model->initial_state()), scratch(model->make_scratch()) {
    out.u.resize(state.u.size());
    K = model->make_tangent();
  }
  VectorX force(const VectorX& u) {
    model->residual({u, {}}, *scratch, out);
    return out.u;
  }
  VectorX product(const VectorX& u, const VectorX& v) {
    model->tangent({u, {}}, *scratch, K);
    VectorX Kv(v.size());
    K.A.multiply(v, Kv);
    return Kv;
  }
  /// u = (F - I) X.
  [[nodiscard]] VectorX affine(const Mat3& F) const {
    VectorX u(state.u.size());
    for (std::size_t i = 0; i < mesh.node_count(); ++i) {
      u.segment<3>(3 * static_cast<Eigen::Index>(i)) = (F - Mat3::Identity()) * mesh.nodes[i];
    }
    return u;
  }

  mesh::TetMesh mesh;
  std::unique_ptr<Model> model;
  State state;
  std::unique_ptr<Scratch> scratch;
  Residual out;
  linalg::SaddleMatrix K;
};

Eigen::MatrixXd dense(const linalg::SymmetricBlockMatrix& A) {
  const Eigen::Index n = 3 * A.rows();
  Eigen::MatrixXd out(n, n);
  VectorX column(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    A.multiply(VectorX::Unit(n, i), column);
    out.col(i) = column;
  }
  return out;
}

TEST(MassSpring, IsAtRestWhereItLies) {
  Case c(kuhn_box({1.0, 2.0, 1.0}, {2, 3, 2}, 0.2));
  EXPECT_EQ(c.model->name(), "mass-spring");
  EXPECT_EQ(c.model->pressure_unknowns(), 0);
  EXPECT_TRUE(c.model->allows_inversion());
  EXPECT_TRUE(c.force(c.state.u).isZero(0.0));
  EXPECT_EQ(c.model->energy(c.state), 0.0);
  EXPECT_GT(c.model->memory_bytes(), c.mesh.tet_count() * 50);
  const TetFields fields = c.model->fields(c.state);
  for (const double J : fields.J) EXPECT_NEAR(J, 1.0, 1e-14);
  EXPECT_TRUE(std::all_of(fields.stress.begin(), fields.stress.end(), [](double s) { return s == 0.0; }));
}

TEST(MassSpring, ForceIsTheGradientOfTheEnergy) {
  Case c(kuhn_box({1.0, 1.0, 1.0}, {2, 2, 2}, 0.2));
  Noise noise(3);
  const VectorX u = noise.vector(c.state.u.size(), 0.1);
  const VectorX v = noise.vector(c.state.u.size(), 1.0);
  const double slope = test::scalar_derivative([&](double s) { return c.model->energy({u + s * v, {}}); }, 2e-3);
  const VectorX force = c.force(u);
  ASSERT_GT(std::abs(slope), 1e-2 * force.norm());
  EXPECT_NEAR(force.dot(v), slope, 1e-11 * force.norm() * v.norm());
}

TEST(MassSpring, TangentIsTheDerivativeOfTheForce) {
  Case c(kuhn_box({1.0, 1.0, 1.0}, {2, 2, 2}, 0.2));
  Noise noise(4);
  const VectorX u = noise.vector(c.state.u.size(), 0.1);
  const VectorX v = noise.vector(c.state.u.size(), 1.0);
  const VectorX slope = test::derivative([&](double s) { return c.force(u + s * v); }, 2e-3);
  const VectorX Kv = c.product(u, v);
  EXPECT_LT((Kv - slope).norm(), 1e-10 * Kv.norm());
}

TEST(MassSpring, IsBlindToRigidMotions) {
  Case c(kuhn_box({1.0, 1.0, 1.0}, {2, 2, 2}, 0.2));
  const Mat3 R = Eigen::AngleAxisd(2.5, Vec3(1.0, -2.0, 0.5).normalized()).toRotationMatrix();
  Noise noise(5);
  const VectorX u = noise.vector(c.state.u.size(), 0.1);
  VectorX turned(u.size());
  for (std::size_t i = 0; i < c.mesh.node_count(); ++i) {
    const auto at = 3 * static_cast<Eigen::Index>(i);
    turned.segment<3>(at) = R * (c.mesh.nodes[i] + u.segment<3>(at)) + Vec3(3.0, 4.0, 5.0) - c.mesh.nodes[i];
  }
  const VectorX force = c.force(u);
  VectorX difference = c.force(turned);
  for (Eigen::Index at = 0; at < u.size(); at += 3) difference.segment<3>(at) -= R * force.segment<3>(at);
  // Rounding of positions near 10 in springs of length near 0.5.
  EXPECT_LT(difference.norm(), 1e-13 * force.norm() * 20.0);
  EXPECT_NEAR(c.model->energy({turned, {}}), c.model->energy({u, {}}), 1e-12 * c.model->energy({u, {}}));
}

// With eps:C:eps = 2 W / V for uniform strains, C_iijj = 9 K and C_ijij = 3 lambda + 12 mu of the isotropic average
// (the projection of C on the isotropic tensors) are sums over springs of k L^2 / V alone, so that the average is exact
// on any mesh, however few directions it has.
void expect_isotropic_average_is_young(Case& c) {
  const double volume = mesh::total_volume(c.mesh);
  const linalg::SymmetricBlockMatrix A0 = c.model->preconditioner().A0;
  const auto contracted = [&](const Mat3& eps) {
    const VectorX u = c.affine(Mat3::Identity() + eps);
    VectorX Ku(u.size());
    A0.multiply(u, Ku);
    return u.dot(Ku) / volume;
  };
  const double C_iijj = contracted(Mat3::Identity());
  double C_ijij = 0.0;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      Mat3 eps = Mat3::Zero();
      eps(i, j) += 0.5;
      eps(j, i) += 0.5;
      C_ijij += contracted(eps);
    }
  }
  // 9 lambda + 6 mu = C_iijj, 3 lambda + 12 mu = C_ijij.
  const double mu = (3.0 * C_ijij - C_iijj) / 30.0;
  const double lambda = (C_iijj - 6.0 * mu) / 9.0;
  EXPECT_NEAR(mu * (3.0 * lambda + 2.0 * mu) / (lambda + mu), kYoung, 1e-12 * kYoung);
  EXPECT_NEAR(lambda / (2.0 * (lambda + mu)), 0.25, 1e-12);
}

TEST(MassSpring, HasYoungsModulusOnTheIsotropicAverage) {
  Case one(test::one_tet());
  expect_isotropic_average_is_young(one);
  Case box(kuhn_box({1.0, 1.0, 3.0}, {3, 3, 9}, 0.25));
  expect_isotropic_average_is_young(box);
}

// The same read off a pulled cube: three sides slide, the far side along x moves by a ten-thousandth. Measured: E 0.86
// and nu 0.277 of this mesh, whose inner nodes give way to the pull; 0.99 to 1.07 and 0.21 to 0.23 on an irregular mesh
// of 552 nodes; 1.18 along the rows of an unjittered Kuhn mesh, which has springs that way.
TEST(MassSpring, PulledCubeHasNearlyYoungsModulusAndAQuarter) {
  const auto mesh = mesh::make_bar({Vec3(1.0, 1.0, 1.0)}, 400);
  ASSERT_TRUE(mesh) << mesh.error().message();
  Case c(*mesh);
  const double stretch = 1e-4;
  Loading loading;
  for (int axis = 0; axis < 3; ++axis) {
    for (const NodeId node : test::nodes_on_plane(*mesh, axis, 0.0)) {
      loading.supports.push_back({3 * node.value() + axis, 0.0});
    }
  }
  const std::vector<NodeId> pulled = test::nodes_on_plane(*mesh, 0, 1.0);
  for (const NodeId node : pulled) loading.supports.push_back({3 * node.value(), stretch});
  ASSERT_GE(test::solve_small(*c.model, loading, 1.0, 1e-10, c.state), 1);

  const VectorX force = c.force(c.state.u);
  double pull = 0.0;
  for (const NodeId node : pulled) pull += force[3 * node.value()];
  EXPECT_NEAR(pull / stretch, kYoung, 0.2 * kYoung);
  double across = 0.0;
  const std::vector<NodeId> side = test::nodes_on_plane(*mesh, 1, 1.0);
  for (const NodeId node : side) across -= c.state.u[3 * node.value() + 1] / static_cast<double>(side.size());
  EXPECT_NEAR(across / stretch, 0.25, 0.05);
}

TEST(MassSpring, RestTangentHoldsAllButRigidMotions) {
  Case c(kuhn_box({1.0, 1.0, 1.0}, {2, 1, 1}, 0.2));
  const linalg::SymmetricBlockMatrix A0 = c.model->preconditioner().A0;
  c.model->tangent(c.state, *c.scratch, c.K);
  EXPECT_EQ(A0.values, c.K.A.values);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(dense(A0));
  const double largest = eigen.eigenvalues().maxCoeff();
  EXPECT_LT(eigen.eigenvalues()[5], 1e-13 * largest);
  EXPECT_GT(eigen.eigenvalues()[6], 1e-3 * largest);
  EXPECT_GT(eigen.eigenvalues()[0], -1e-13 * largest);
}

TEST(MassSpring, TangentLosesDefinitenessInCompression) {
  Case c(test::one_tet());
  c.model->tangent({c.affine(0.5 * Mat3::Identity()), {}}, *c.scratch, c.K);
  EXPECT_LT(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(dense(c.K.A)).eigenvalues()[0], -0.1 * kYoung);
}

// Sum over tets of (volume x stress) is the virial of the nodal forces, sum of x (x) R.
TEST(MassSpring, StressIsTheVirial) {
  Case c(kuhn_box({1.0, 1.0, 1.0}, {2, 2, 2}, 0.2));
  Noise noise(6);
  const VectorX u = noise.vector(c.state.u.size(), 0.05);
  const VectorX force = c.force(u);
  const TetFields fields = c.model->fields({u, {}});
  Mat3 virial = Mat3::Zero();
  for (std::size_t i = 0; i < c.mesh.node_count(); ++i) {
    const auto at = 3 * static_cast<Eigen::Index>(i);
    virial += (c.mesh.nodes[i] + u.segment<3>(at)) * force.segment<3>(at).transpose();
  }
  Mat3 sum = Mat3::Zero();
  for (std::size_t t = 0; t < c.mesh.tet_count(); ++t) {
    const double* s = &fields.stress[6 * t];
    const double volume = fields.J[t] * mesh::signed_volume(c.mesh, TetId(t));
    ASSERT_GT(volume, 0.0);
    Mat3 stress;
    stress << s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2];
    sum += volume * stress;
    EXPECT_NEAR(fields.lambda[t], stress.trace() / 3.0, 1e-13 * std::abs(stress.trace()));
    EXPECT_NEAR(fields.J[t], c.scratch->J[static_cast<Eigen::Index>(t)], 0.0);
  }
  EXPECT_LT((sum - virial).norm(), 1e-12 * virial.norm());
}

TEST(MassSpring, CountsInvertedTetsAndStaysFinite) {
  Case c(test::one_tet());
  Mat3 mirror = Mat3::Identity();
  mirror(2, 2) = -0.7;
  const Evaluation inverted = c.model->residual({c.affine(mirror), {}}, *c.scratch, c.out);
  EXPECT_EQ(inverted.inverted_tets, 1);
  EXPECT_EQ(inverted.worst_tet, TetId(0));
  EXPECT_NEAR(inverted.min_J, -0.7, 1e-14);
  EXPECT_TRUE(inverted.finite);
  EXPECT_TRUE(c.out.u.allFinite());

  // All nodes in one point: no spring has a direction.
  const VectorX collapsed = c.affine(Mat3::Zero());
  EXPECT_EQ(c.model->tangent({collapsed, {}}, *c.scratch, c.K).inverted_tets, 1);
  EXPECT_TRUE(c.force(collapsed).allFinite());
  EXPECT_TRUE(
      Eigen::Map<const VectorX>(c.K.A.values.data(), static_cast<Eigen::Index>(c.K.A.values.size())).allFinite());
  const TetFields fields = c.model->fields({collapsed, {}});
  EXPECT_TRUE(std::all_of(fields.stress.begin(), fields.stress.end(), [](double s) { return std::isfinite(s); }));
}

TEST(MassSpring, NamesTheFirstTetThatIsNotFinite) {
  Case c(kuhn_box({1.0, 1.0, 1.0}, {2, 2, 2}));
  const std::size_t last = c.mesh.node_count() - 1;
  VectorX u = c.state.u;
  u[3 * static_cast<Eigen::Index>(last) + 1] = std::numeric_limits<double>::quiet_NaN();
  const auto has_last = [&](const mesh::Tet& tet) {
    return std::find(tet.begin(), tet.end(), NodeId(last)) != tet.end();
  };
  const auto first = std::find_if(c.mesh.tets.begin(), c.mesh.tets.end(), has_last) - c.mesh.tets.begin();
  const Evaluation evaluation = c.model->residual({u, {}}, *c.scratch, c.out);
  EXPECT_FALSE(evaluation.finite);
  EXPECT_EQ(evaluation.worst_tet, TetId(static_cast<std::size_t>(first)));
}

TEST(MassSpring, GivesTheSameBitsOnAnyNumberOfThreads) {
  Case c(kuhn_box({1.0, 1.0, 1.0}, {10, 10, 10}, 0.2));
  const VectorX u = Noise(8).vector(c.state.u.size(), 0.01);
  const int threads = thread_count();
  set_thread_count(1);
  const VectorX force = c.force(u);
  c.model->tangent({u, {}}, *c.scratch, c.K);
  const std::vector<double> values = c.K.A.values;
  set_thread_count(4);
  EXPECT_EQ(c.force(u), force);
  c.model->tangent({u, {}}, *c.scratch, c.K);
  EXPECT_EQ(c.K.A.values, values);
  set_thread_count(threads);
}

}  // namespace
}  // namespace rhexis::model
