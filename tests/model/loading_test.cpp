#include "model/loading.h"

#include <gtest/gtest.h>

#include <functional>

#include <Eigen/Dense>

#include "mesh/surface.h"
#include "tests/model/test_bodies.h"

namespace rhexis::model {
namespace {

using test::kuhn_box;
using test::Noise;

const Vec3 kSize(0.7, 0.9, 1.2);

/// Body, space and surface of one order.
struct Body {
  explicit Body(int order) : mesh(kuhn_box(kSize, {2, 2, 3}, 0.2)) {
    space = order == 1 ? make_p1_space(mesh) : make_p2_space(mesh);
    surface = mesh::find_faces(mesh).boundary;
  }
  [[nodiscard]] Eigen::Index dofs() const { return static_cast<Eigen::Index>(space.dof_count()); }

  [[nodiscard]] std::vector<mesh::TetFace> side(int axis, double value) const {
    std::vector<mesh::TetFace> faces;
    for (const mesh::TetFace& face : surface) {
      const auto n = mesh::face_nodes(mesh, face);
      if (std::all_of(n.begin(), n.end(), [&](NodeId i) { return std::abs(mesh.node(i)[axis] - value) < 1e-9; })) {
        faces.push_back(face);
      }
    }
    return faces;
  }

  /// The values of a vector field at the nodes.
  [[nodiscard]] VectorX interpolate(const std::function<Vec3(const Vec3&)>& field) const {
    VectorX out(dofs());
    for (std::size_t i = 0; i < space.node_count(); ++i) {
      out.segment<3>(3 * static_cast<Eigen::Index>(i)) = field(space.nodes[i]);
    }
    return out;
  }

  [[nodiscard]] linalg::SaddleMatrix empty_tangent() const {
    linalg::SaddleMatrix K;
    K.A = linalg::SymmetricBlockMatrix(std::make_shared<linalg::BlockPattern>(linalg::make_block_pattern(
        static_cast<std::int32_t>(space.node_count()), space.connectivity, space.nodes_per_tet())));
    return K;
  }

  /// All three components of the nodes on a plane.
  [[nodiscard]] std::vector<PrescribedDof> clamp(int axis, double value) const {
    std::vector<PrescribedDof> supports;
    for (const std::int32_t node : nodes_of_set(space, test::nodes_on_plane(mesh, axis, value))) {
      for (std::int32_t c = 0; c < 3; ++c) supports.push_back({3 * node + c, 0.0});
    }
    return supports;
  }

  mesh::TetMesh mesh;
  DisplacementSpace space;
  std::vector<mesh::TetFace> surface;
};

/// det of grad x over the body, by the five-point rule of degree 3 (exact: det F is a cubic for P2), with gradients by
/// hand: an oracle that shares nothing with the surface integrals.
double deformed_volume(const Body& body, const VectorX& u) {
  const auto per_tet = static_cast<std::size_t>(body.space.nodes_per_tet());
  double volume = 0.0;
  for (std::size_t t = 0; t < body.mesh.tet_count(); ++t) {
    Eigen::Matrix<double, 3, Eigen::Dynamic> x(3, per_tet);
    for (std::size_t a = 0; a < per_tet; ++a) {
      const std::int32_t node = body.space.connectivity[t * per_tet + a];
      x.col(static_cast<Eigen::Index>(a)) = body.space.nodes[static_cast<std::size_t>(node)] + u.segment<3>(3 * node);
    }
    for (int q = 0; q < 5; ++q) {
      Eigen::Vector4d L = Eigen::Vector4d::Constant(q == 4 ? 0.25 : 1.0 / 6.0);
      if (q < 4) L[q] = 0.5;
      // d x / d L_i, then along the edges from vertex 0.
      Eigen::Matrix<double, 3, 4> dx = Eigen::Matrix<double, 3, 4>::Zero();
      if (per_tet == 4) {
        dx = x;
      } else {
        for (int i = 0; i < 4; ++i) dx.col(i) += (4.0 * L[i] - 1.0) * x.col(i);
        for (int e = 0; e < 6; ++e) {
          const auto& [i, j] = mesh::kTetEdges[static_cast<std::size_t>(e)];
          dx.col(i) += 4.0 * L[j] * x.col(4 + e);
          dx.col(j) += 4.0 * L[i] * x.col(4 + e);
        }
      }
      const Mat3 jacobian = dx.rightCols<3>().colwise() - dx.col(0);
      volume += (q == 4 ? -0.8 : 0.45) * jacobian.determinant() / 6.0;
    }
  }
  return volume;
}

class LoadingOfOrder : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(, LoadingOfOrder, testing::Values(1, 2),
                         [](const auto& p) { return p.param == 1 ? "P1" : "P2"; });

// The nodal forces of a consistent load do on the values of a polynomial exactly the work of the load on the
// polynomial.
TEST_P(LoadingOfOrder, BodyForceDoesTheWorkOfTheIntegral) {
  const Body body(GetParam());
  const Vec3 density(3.0, -5.0, 7.0);
  VectorX force = VectorX::Zero(body.dofs());
  add_body_force(body.mesh, body.space, density, force);
  const double volume = kSize.prod();
  const VectorX linear = body.interpolate([](const Vec3& X) { return Vec3(1.0 + X.x(), X.y() - 2.0 * X.z(), X.z()); });
  const Vec3 mean_linear(1.0 + kSize.x() / 2, kSize.y() / 2 - kSize.z(), kSize.z() / 2);
  EXPECT_NEAR(force.dot(linear), volume * density.dot(mean_linear), 1e-13 * volume * density.norm());
  if (GetParam() == 1) return;
  const VectorX quadratic =
      body.interpolate([](const Vec3& X) { return Vec3(X.x() * X.x(), X.y() * X.z(), X.z() * X.z() - X.x() * X.y()); });
  const Vec3 mean_quadratic(kSize.x() * kSize.x() / 3, kSize.y() * kSize.z() / 4,
                            kSize.z() * kSize.z() / 3 - kSize.x() * kSize.y() / 4);
  EXPECT_NEAR(force.dot(quadratic), volume * density.dot(mean_quadratic), 1e-13 * volume * density.norm());
}

TEST_P(LoadingOfOrder, TractionSpreadsTheTotalForceEvenly) {
  const Body body(GetParam());
  const Vec3 total(30.0, -50.0, 70.0);
  VectorX force = VectorX::Zero(body.dofs());
  add_traction(body.mesh, body.space, body.side(2, kSize.z()), total, force);
  const VectorX linear = body.interpolate([](const Vec3& X) { return Vec3(1.0 + X.x(), X.y() - 2.0 * X.z(), X.z()); });
  const Vec3 mean_linear(1.0 + kSize.x() / 2, kSize.y() / 2 - 2.0 * kSize.z(), kSize.z());
  EXPECT_NEAR(force.dot(linear), total.dot(mean_linear), 1e-13 * total.norm());
  if (GetParam() == 1) return;
  const VectorX quadratic =
      body.interpolate([](const Vec3& X) { return Vec3(X.x() * X.x(), X.x() * X.y(), X.y() * X.y()); });
  const Vec3 mean_quadratic(kSize.x() * kSize.x() / 3, kSize.x() * kSize.y() / 4, kSize.y() * kSize.y() / 3);
  EXPECT_NEAR(force.dot(quadratic), total.dot(mean_quadratic), 1e-13 * total.norm());
}

TEST(Loading, ForceSharesAreThoseOfThePaper) {
  const mesh::TetMesh mesh = test::one_tet();
  const DisplacementSpace space = make_p1_space(mesh);
  VectorX force = VectorX::Zero(12);
  add_body_force(mesh, space, Vec3(0.0, 0.0, -9.81), force);
  const double share = -9.81 * mesh::signed_volume(mesh, TetId(0)) / 4.0;
  for (int a = 0; a < 4; ++a) EXPECT_DOUBLE_EQ(force[3 * a + 2], share);
}

TEST_P(LoadingOfOrder, PressureOnAFlatSidePushesAgainstItsNormal) {
  const Body body(GetParam());
  const FollowerPressure load = make_follower_pressure(body.mesh, body.space, body.side(2, kSize.z()), 40.0, {});
  VectorX force = VectorX::Zero(body.dofs());
  add_pressure_force(load, body.space, VectorX::Zero(body.dofs()), 0.5, force);
  VectorX traction = VectorX::Zero(body.dofs());
  add_traction(body.mesh, body.space, body.side(2, kSize.z()), Vec3(0.0, 0.0, -0.5 * 40.0 * kSize.x() * kSize.y()),
               traction);
  EXPECT_LT((force - traction).cwiseAbs().maxCoeff(), 1e-14 * 40.0);
}

// Virtual work: on a closed surface the force is minus the gradient of p V. V(u + s v) is a cubic in s, whose
// derivative the five-point formula gives exactly: no small steps, no cancellation.
TEST_P(LoadingOfOrder, PressureOnAClosedSurfaceDerivesFromPTimesV) {
  const Body body(GetParam());
  Noise noise(11);
  const VectorX u = noise.vector(body.dofs(), 0.05);
  const FollowerPressure load = make_follower_pressure(body.mesh, body.space, body.surface, 40.0, {});
  EXPECT_TRUE(load.closed_or_held_rim);
  VectorX force = VectorX::Zero(body.dofs());
  add_pressure_force(load, body.space, u, 0.75, force);
  ASSERT_GT(force.norm(), 1.0);
  for (int trial = 0; trial < 5; ++trial) {
    const VectorX v = noise.vector(body.dofs(), 1.0);
    const auto volume = [&](double s) { return deformed_volume(body, u + s * v); };
    const double h = 0.25;
    const double dV = (8.0 * (volume(h) - volume(-h)) - (volume(2.0 * h) - volume(-2.0 * h))) / (12.0 * h);
    ASSERT_GT(std::abs(dV), 1e-3);
    EXPECT_NEAR(force.dot(v), -0.75 * 40.0 * dV, 1e-12 * force.norm() * v.norm());
  }
}

TEST_P(LoadingOfOrder, PressureOnAClosedSurfaceHasNoResultant) {
  const Body body(GetParam());
  Noise noise(12);
  const VectorX u = noise.vector(body.dofs(), 0.05);
  const FollowerPressure load = make_follower_pressure(body.mesh, body.space, body.surface, 40.0, {});
  VectorX force = VectorX::Zero(body.dofs());
  add_pressure_force(load, body.space, u, 1.0, force);
  Vec3 sum = Vec3::Zero();
  Vec3 moment = Vec3::Zero();
  for (std::size_t i = 0; i < body.space.node_count(); ++i) {
    const auto at = 3 * static_cast<Eigen::Index>(i);
    sum += force.segment<3>(at);
    moment += (body.space.nodes[i] + u.segment<3>(at)).cross(force.segment<3>(at));
  }
  EXPECT_LT(sum.norm(), 1e-13 * force.norm());
  EXPECT_LT(moment.norm(), 1e-13 * force.norm());
}

/// -t d(force)/du v. The force is a quadratic in u, so that the central difference is exact for any step.
VectorX minus_force_derivative(const Body& body, const FollowerPressure& load, const VectorX& u, double t,
                               const VectorX& v) {
  VectorX plus = VectorX::Zero(body.dofs());
  VectorX minus = VectorX::Zero(body.dofs());
  add_pressure_force(load, body.space, u + v, t, plus);
  add_pressure_force(load, body.space, u - v, t, minus);
  return 0.5 * (minus - plus);
}

TEST_P(LoadingOfOrder, StiffnessOfAClosedSurfaceIsSymmetricAndExact) {
  const Body body(GetParam());
  Noise noise(13);
  const VectorX u = noise.vector(body.dofs(), 0.05);
  const FollowerPressure load = make_follower_pressure(body.mesh, body.space, body.surface, 40.0, {});
  linalg::SaddleMatrix K = body.empty_tangent();
  subtract_pressure_stiffness(load, body.space, u, 0.75, K);
  EXPECT_FALSE(K.skew.has_value());
  const VectorX v = noise.vector(body.dofs(), 1.0);
  VectorX Kv(body.dofs());
  K.A.multiply(v, Kv);
  ASSERT_GT(Kv.norm(), 1.0);
  EXPECT_LT((Kv - minus_force_derivative(body, load, u, 0.75, v)).norm(), 1e-13 * Kv.norm());
}

TEST_P(LoadingOfOrder, StiffnessOfAFreeRimIsExactWithItsSkewPart) {
  const Body body(GetParam());
  Noise noise(14);
  const VectorX u = noise.vector(body.dofs(), 0.05);
  const FollowerPressure load = make_follower_pressure(body.mesh, body.space, body.side(0, kSize.x()), 40.0, {});
  EXPECT_FALSE(load.closed_or_held_rim);
  linalg::SaddleMatrix K = body.empty_tangent();
  subtract_pressure_stiffness(load, body.space, u, 0.5, K);
  subtract_pressure_stiffness(load, body.space, u, 0.25, K);  // adds up
  ASSERT_TRUE(K.skew.has_value());
  const VectorX v = noise.vector(body.dofs(), 1.0);
  VectorX Kv(body.dofs());
  VectorX none;
  K.multiply(v, none, Kv, none);
  EXPECT_LT((Kv - minus_force_derivative(body, load, u, 0.75, v)).norm(), 1e-13 * Kv.norm());
  VectorX symmetric(body.dofs());
  K.A.multiply(v, symmetric);
  EXPECT_GT((Kv - symmetric).norm(), 1e-2 * Kv.norm());  // the skew part is no rounding
  EXPECT_LT(std::abs(v.dot(Kv - symmetric)), 1e-13 * v.norm() * Kv.norm());
}

// Pressure on the whole surface but one side, which is clamped: the rim is the clamped side's.
TEST_P(LoadingOfOrder, StiffnessOfAHeldRimIsSymmetricAndExactWhereUnknownsAreFree) {
  const Body body(GetParam());
  std::vector<mesh::TetFace> faces = body.surface;
  const std::vector<mesh::TetFace> bottom = body.side(2, 0.0);
  std::erase_if(faces,
                [&](const mesh::TetFace& f) { return std::find(bottom.begin(), bottom.end(), f) != bottom.end(); });
  const std::vector<PrescribedDof> supports = body.clamp(2, 0.0);
  const FollowerPressure load = make_follower_pressure(body.mesh, body.space, faces, 40.0, supports);
  EXPECT_TRUE(load.closed_or_held_rim);

  Noise noise(15);
  const VectorX u = noise.vector(body.dofs(), 0.05);
  linalg::SaddleMatrix K = body.empty_tangent();
  subtract_pressure_stiffness(load, body.space, u, 1.0, K);
  EXPECT_FALSE(K.skew.has_value());
  const VectorX v = noise.vector(body.dofs(), 1.0);  // supports may move, too
  VectorX difference(body.dofs());
  K.A.multiply(v, difference);
  const double size = difference.norm();
  difference -= minus_force_derivative(body, load, u, 1.0, v);
  EXPECT_GT(difference.norm(), 1e-3 * size);  // at the rim the skew part is left out
  for (const PrescribedDof& support : supports) difference[support.dof] = 0.0;
  EXPECT_LT(difference.norm(), 1e-13 * size);
}

TEST_P(LoadingOfOrder, RimCountsAsHeldOnlyWithAllComponentsAndMiddles) {
  const Body body(GetParam());
  std::vector<PrescribedDof> supports = body.clamp(2, kSize.z());
  const std::vector<mesh::TetFace> top = body.side(2, kSize.z());
  EXPECT_TRUE(make_follower_pressure(body.mesh, body.space, top, 1.0, supports).closed_or_held_rim);
  // Without any one of the components of the last node (P2: the middle of a rim edge).
  const std::int32_t last = supports.back().dof / 3;
  const Vec3& X = body.space.nodes[static_cast<std::size_t>(last)];
  ASSERT_TRUE(X.x() == 0.0 || X.x() == kSize.x() || X.y() == 0.0 || X.y() == kSize.y());
  for (std::int32_t c = 0; c < 3; ++c) {
    std::vector<PrescribedDof> fewer = supports;
    std::erase_if(fewer, [&](const PrescribedDof& s) { return s.dof == 3 * last + c; });
    EXPECT_FALSE(make_follower_pressure(body.mesh, body.space, top, 1.0, fewer).closed_or_held_rim);
  }
  // Nodes within the surface need not be held.
  const std::vector<NodeId> inner = {NodeId(std::size_t{(3 * 3 + 1) * 3 + 1})};
  ASSERT_NEAR(body.mesh.node(inner[0]).z(), kSize.z(), 1e-15);
  std::erase_if(supports, [&](const PrescribedDof& s) { return s.dof / 3 == inner[0].value(); });
  EXPECT_TRUE(make_follower_pressure(body.mesh, body.space, top, 1.0, supports).closed_or_held_rim);
}

}  // namespace
}  // namespace rhexis::model
