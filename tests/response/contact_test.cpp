#include "response/contact.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include <limits>

#include "mesh/generate.h"
#include "mesh/surface.h"
#include "response/exact_response.h"
#include "tests/support/torn_body_oracle.h"

namespace rhexis::response::test {
namespace {

using rhexis::test::TornBodyOracle;

mesh::TetMesh bar() { return mesh::make_bar({{0.08, 0.03, 0.04}}, 300).value(); }

ElasticBody held_bar(const mesh::TetMesh& mesh) {
  ElasticBody body;
  body.elastic = {.young = 2.0e5, .poisson = 0.4};
  body.density = 1000.0;
  body.gravity = {0.0, -9.81, 0.0};
  for (const NodeId node : mesh.find_node_set("-x")->nodes)
    for (std::int32_t c = 0; c < 3; ++c) body.supports.push_back({3 * node.value() + c, 0.0});
  return body;
}

/// A grid of points that is fine enough to be as near as any, on each triangle.
double slow_distance(const mesh::TornMesh& body, const Vec3& at) {
  double best = std::numeric_limits<double>::infinity();
  for (const mesh::TetFace face : mesh::find_faces(body.mesh()).boundary) {
    const auto n = mesh::face_nodes(body.mesh(), face);
    for (int i = 0; i <= 40; ++i) {
      for (int j = 0; i + j <= 40; ++j) {
        const Vec3 w(i / 40.0, j / 40.0, (40 - i - j) / 40.0);
        const Vec3 x = w[0] * body.mesh().node(n[0]) + w[1] * body.mesh().node(n[1]) + w[2] * body.mesh().node(n[2]);
        best = std::min(best, (x - at).norm());
      }
    }
  }
  return best;
}

TEST(NearestSurfacePoint, IsAsNearAsAnyPointOfTheSurface) {
  const mesh::TornMesh body(bar());
  for (int k = 0; k < 30; ++k) {
    const Vec3 at(0.04 + 0.06 * std::sin(3 * k), 0.015 + 0.03 * std::cos(5 * k), 0.02 + 0.03 * std::sin(7 * k + 1));
    const auto point = nearest_surface_point(body, at);
    ASSERT_TRUE(point);
    // Two points of the grid are 0.01 / 40 apart at most.
    EXPECT_NEAR((point->position - at).norm(), slow_distance(body, at), 2e-4);
    EXPECT_LE((point->position - at).norm(), slow_distance(body, at) + 1e-15);
    EXPECT_NEAR(point->weight.sum(), 1.0, 1e-15);
    EXPECT_NEAR(point->normal.norm(), 1.0, 1e-14);
    EXPECT_GT(point->weight.head(point->count).minCoeff(), 0.0);
    Vec3 sum = Vec3::Zero();
    for (int i = 0; i < point->count; ++i)
      sum += point->weight[i] * body.mesh().node(point->node[static_cast<std::size_t>(i)]);
    EXPECT_LT((sum - point->position).norm(), 1e-16);
  }
}

TEST(NearestSurfacePoint, HasTheNormalOfItsSide) {
  const mesh::TornMesh body(bar());
  const auto top = nearest_surface_point(body, Vec3(0.0312, 0.04, 0.0173));
  EXPECT_LT((top->normal - Vec3::UnitY()).norm(), 1e-12);
  EXPECT_LT((top->position - Vec3(0.0312, 0.03, 0.0173)).norm(), 1e-15);
  EXPECT_EQ(top->count, 3);
  // From inside as well, and at a corner the three sides count alike however they are cut.
  const auto below = nearest_surface_point(body, Vec3(0.0312, 0.001, 0.0173));
  EXPECT_LT((below->normal + Vec3::UnitY()).norm(), 1e-12);
  const auto corner = nearest_surface_point(body, Vec3(0.1, 0.05, 0.06));
  EXPECT_EQ(corner->count, 1);
  EXPECT_EQ(corner->weight, Vec3::UnitX());
  EXPECT_LT((corner->normal - Vec3::Ones() / std::sqrt(3.0)).norm(), 1e-12);
}

TEST(NearestSurfacePoint, SnapsToAVertexWithinReach) {
  const mesh::TornMesh body(bar());
  const Vec3 at = Vec3(0.08, 0.03, 0.04) - Vec3(0.001, 0.0, 0.002);
  EXPECT_GT(nearest_surface_point(body, at)->count, 1);
  const auto snapped = nearest_surface_point(body, at, 0.004);
  EXPECT_EQ(snapped->count, 1);
  EXPECT_EQ(snapped->position, Vec3(0.08, 0.03, 0.04));
}

TEST(NearestSurfacePoint, KeepsOffWhatIsRemovedAndFrozen) {
  mesh::TornMesh body(bar());
  const Vec3 at(0.1, 0.015, 0.02);
  mesh::MeshEdit removal;
  mesh::MeshEdit frozen;
  for (std::size_t t = 0; t < body.mesh().tet_count(); ++t) {
    const auto x = mesh::corners(body.mesh(), TetId(t));
    const double middle = 0.25 * (x[0] + x[1] + x[2] + x[3])[0];
    if (middle > 0.06) removal.removed.emplace_back(t);
    if (middle > 0.04 && middle <= 0.06) frozen.frozen.emplace_back(t);
  }
  body.apply(removal);
  const double after_removal = nearest_surface_point(body, at)->position[0];
  EXPECT_LT(after_removal, 0.07);
  EXPECT_GT(after_removal, 0.05);
  body.apply(frozen);
  EXPECT_LT(nearest_surface_point(body, at)->position[0], 0.05);

  mesh::MeshEdit rest;
  for (std::size_t t = 0; t < body.mesh().tet_count(); ++t) {
    if (body.is_solved(TetId(t))) rest.frozen.emplace_back(t);
  }
  body.apply(rest);
  EXPECT_FALSE(nearest_surface_point(body, at));
}

/// A bar, its whole inverse, and a point of its surface.
struct Held {
  mesh::TornMesh body{bar()};
  ElasticBody elastic = held_bar(body.mesh());
  TornBodyOracle oracle{body, elastic};
  SurfacePoint point;
  std::vector<NodeId> nodes;
  Eigen::MatrixXd compliance;
  VectorX rest;

  explicit Held(const Vec3& at, double snap = 0.0) : point(*nearest_surface_point(body, at, snap)) {
    nodes.assign(point.node.begin(), point.node.begin() + point.count);
    compliance = oracle.compliance(nodes);
    rest = oracle.rest(nodes);
  }
  [[nodiscard]] ContactLaw law(ContactRule rule, ContactMode mode) const {
    return make_contact_law(point, rule, mode, compliance, rest);
  }
  /// Displacement of the point with given forces on its nodes, from all of the body.
  [[nodiscard]] Vec3 moved(const VectorX& forces) {
    const VectorX u = TornBodyOracle::at(nodes, oracle.displacement(nodes, forces));
    Vec3 out = Vec3::Zero();
    for (int i = 0; i < point.count; ++i) out += point.weight[i] * u.segment<3>(3 * i);
    return out;
  }
};

const Vec3 kOnTop(0.0612, 0.031, 0.0173);
const Vec3 kHand(0.002, -0.003, 0.001);

TEST(ContactLaw, ConsistentBringsThePointToTheHand) {
  Held held(kOnTop);
  ASSERT_EQ(held.point.count, 3);
  const ContactLaw law = held.law(ContactRule::consistent, ContactMode::hold);
  const VectorX forces = law.nodal_forces(kHand).head(9);
  // The point is at the hand in the solution of the whole body: solved twice with the condition of K, some 1e4.
  EXPECT_LT((held.moved(forces) - kHand).norm(), 1e-11 * kHand.norm());
  Vec3 sum = Vec3::Zero();
  for (int i = 0; i < 3; ++i) sum += forces.segment<3>(3 * i);
  EXPECT_LT((sum - law.force(kHand)).norm(), 1e-13 * sum.norm());
  EXPECT_GT(sum.norm(), 0.0);
  EXPECT_TRUE(law.force(law.rest).isZero(0.0)) << "no force where the loads alone take it";
  EXPECT_GT(law.rest.norm(), 0.0);
}

TEST(ContactLaw, BlendIsTheReactionsOfTheVerticesAloneByAreaCoordinates) {
  Held held(kOnTop);
  const ContactLaw law = held.law(ContactRule::blend, ContactMode::hold);
  Vec3 expected = Vec3::Zero();
  for (int i = 0; i < 3; ++i) {
    // (3.32): one vertex displaced, the others free; (3.33): blended.
    const Eigen::MatrixXd alone = held.oracle.compliance({held.nodes[static_cast<std::size_t>(i)]});
    expected += held.point.weight[i] * alone.inverse() * (kHand - law.rest);
  }
  EXPECT_LT((law.force(kHand) - expected).norm(), 1e-10 * expected.norm());
  EXPECT_GT((law.force(kHand) - held.law(ContactRule::consistent, ContactMode::hold).force(kHand)).norm(),
            1e-3 * expected.norm())
      << "the two rules differ inside a triangle";
}

TEST(ContactLaw, BothRulesAgreeAtAVertex) {
  const Held held(Vec3(0.08, 0.03, 0.04), 1e-3);
  ASSERT_EQ(held.point.count, 1);
  for (const ContactMode mode : {ContactMode::hold, ContactMode::push}) {
    const Vec3 one = held.law(ContactRule::consistent, mode).force(kHand - Vec3(0.01, 0.0, 0.01));
    const Vec3 other = held.law(ContactRule::blend, mode).force(kHand - Vec3(0.01, 0.0, 0.01));
    EXPECT_GT(one.norm(), 0.0);
    EXPECT_LT((one - other).norm(), 1e-13 * one.norm());
  }
}

TEST(ContactLaw, IsThatOfTheInverseOfTheWholeMatrix) {
  // By hand: L = K^-1 column by column, at a vertex f = L_cc^-1 u (3.30).
  Held held(Vec3(0.08, 0.0, 0.0), 1e-3);
  const ContactLaw law = held.law(ContactRule::consistent, ContactMode::hold);
  Mat3 L_cc;
  for (int j = 0; j < 3; ++j) {
    const VectorX u =
        held.oracle.displacement(held.nodes, Vec3::Unit(j)) - held.oracle.displacement(held.nodes, Vec3::Zero());
    L_cc.col(j) = TornBodyOracle::at(held.nodes, u);
  }
  const Vec3 expected = L_cc.inverse() * (kHand - held.rest);
  EXPECT_LT((law.force(kHand) - expected).norm(), 1e-10 * expected.norm());
}

TEST(ContactLaw, PushPullsNeverAndHasNoFriction) {
  Held held(kOnTop);
  for (const ContactRule rule : {ContactRule::consistent, ContactRule::blend}) {
    const ContactLaw law = held.law(rule, ContactMode::push);
    const Vec3 n = held.point.normal;
    int pressed = 0;
    for (int k = 0; k < 40; ++k) {
      const Vec3 hand = law.rest + 0.003 * Vec3(std::sin(k), std::cos(2 * k), std::sin(3 * k + 1));
      const Vec3 force = law.force(hand);
      EXPECT_LE(force.dot(n), 0.0);
      EXPECT_LT((force - n * n.dot(force)).norm(), 1e-14 * (1.0 + force.norm()));
      if ((hand - law.rest).dot(n) >= 0.0) {
        EXPECT_TRUE(force.isZero(0.0));
        EXPECT_TRUE(law.nodal_forces(hand).isZero(0.0));
        continue;
      }
      ++pressed;
      EXPECT_GT(force.norm(), 0.0);
      if (rule != ContactRule::consistent) continue;
      // Along the normal the point is at the hand; across it, wherever the body goes.
      EXPECT_NEAR((held.moved(law.nodal_forces(hand).head(9)) - hand).dot(n), 0.0, 1e-11 * 0.003);
    }
    EXPECT_GT(pressed, 5);
  }
}

TEST(ContactLaw, IsTheSameFromTheExactResponse) {
  Held held(kOnTop);
  ExactSettings settings;
  settings.body = held.elastic;
  const auto response = ExactResponse::make(held.body, settings, {});
  response->grasp(held.nodes);
  for (const ContactRule rule : {ContactRule::consistent, ContactRule::blend}) {
    const ContactLaw fast =
        make_contact_law(held.point, rule, ContactMode::hold, response->compliance(), response->rest());
    const Vec3 expected = held.law(rule, ContactMode::hold).force(kHand);
    EXPECT_LT((fast.force(kHand) - expected).norm(), 1e-11 * expected.norm());
  }
}

}  // namespace
}  // namespace rhexis::response::test
