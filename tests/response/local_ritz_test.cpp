#include "response/local_ritz.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "tests/record/build/recorded_plate.h"
#include "tests/support/torn_body_oracle.h"

namespace rhexis::response::test {
namespace {

using record::build::TornState;
using rhexis::test::TornBodyOracle;

/// Stiffnesses by factors in another order differ by rounding times the condition number, 1e5 to 1e6, and the far
/// energy is what is left of two numbers of the size of the stiffness. Measured: 4e-11.
constexpr double kRounding = 1e-9;

/// A plate with its crack run on by 40 mm at some angles, degrees; two of them are recorded.
class LocalRitzTest : public testing::Test {
 protected:
  LocalRitzTest()
      : request_(record::build::test::plate(260, false)), model_(request_.elastic, request_.mesh.node_count()) {
    for (const double angle : {60.0, 90.0}) recorded_.push_back(torn(angle));
    for (const TornState& state : recorded_) shapes_.push_back(shape_of(state.body.mesh()));
  }

  TornState torn(double angle) const {
    TornState state = *TornState::begin(request_.mesh, request_.elastic, request_.crack);
    state.advance(record::build::frame_of(request_.crack).direction(angle), 0.0403);
    return state;
  }
  std::vector<TetId> differing(const TornShape& shape) const {
    return differing_tets(request_.mesh, std::vector<const TornShape*>{&shapes_[0], &shapes_[1], &shape});
  }
  Mat3 exact(const TornState& state, NodeId point) const {
    return TornBodyOracle(state.body.mesh(), request_.elastic).compliance({point}).inverse();
  }
  PointFields fields(const LocalRegion& region, NodeId point) const {
    std::vector<Eigen::MatrixXd> compliance;
    std::vector<Mat3> stiffness;
    std::vector<const TornShape*> shapes;
    for (std::size_t k = 0; k < recorded_.size(); ++k) {
      TornBodyOracle oracle(recorded_[k].body.mesh(), request_.elastic);
      Eigen::MatrixXd columns(static_cast<Eigen::Index>(region.dofs().size()), 3);
      for (Eigen::Index c = 0; c < 3; ++c) {
        const VectorX u = oracle.displacement({point}, Vec3::Unit(c));
        for (Eigen::Index i = 0; i < columns.rows(); ++i) columns(i, c) = u[region.dofs()[static_cast<std::size_t>(i)]];
      }
      compliance.push_back(std::move(columns));
      stiffness.push_back(exact(recorded_[k], point));
      shapes.push_back(&shapes_[k]);
    }
    return RecordedBodies(region, shapes).fields(point, compliance, stiffness);
  }
  Mat3 stiffness(const TornState& state, NodeId point, std::span<const TetId> differing) const {
    const LocalRegion region(request_.mesh, model_, differing);
    const LocalRitz ritz(region, shape_of(state.body.mesh()));
    EXPECT_FALSE(ritz.singular());
    return ritz.stiffness(fields(region, point));
  }
  /// Free nodes: one beside the crack's mouth, one far away, and one that the crack passes.
  std::vector<NodeId> points() const {
    std::vector<NodeId> out;
    for (const Vec3& at : {Vec3(0.10, 0.0, 0.005), Vec3(0.0, 0.24, 0.01), Vec3(0.13, 0.08, 0.0)}) {
      NodeId nearest(0);
      for (std::size_t i = 0; i < request_.mesh.node_count(); ++i)
        if ((request_.mesh.nodes[i] - at).norm() < (request_.mesh.nodes[nearest.index()] - at).norm())
          nearest = NodeId(i);
      out.push_back(nearest);
    }
    return out;
  }

  record::build::CampaignRequest request_;
  ElasticModel model_;
  std::vector<TornState> recorded_;
  std::vector<TornShape> shapes_;
};

TEST_F(LocalRitzTest, TetsDifferWhereOneIsGoneOrANodeIsElsewhere) {
  const TornState state = torn(75.0);
  const TornShape shape = shape_of(state.body.mesh());
  std::vector<TetId> expected;
  for (std::size_t t = 0; t < request_.mesh.tet_count(); ++t) {
    bool differs = false;
    for (const TornState* other : {&recorded_[0], &recorded_[1]}) {
      const mesh::TornMesh& a = state.body.mesh();
      const mesh::TornMesh& b = other->body.mesh();
      differs = differs || a.is_solved(TetId(t)) != b.is_solved(TetId(t)) ||
                (a.is_solved(TetId(t)) && mesh::corners(a.mesh(), TetId(t)) != mesh::corners(b.mesh(), TetId(t)));
    }
    if (differs) expected.emplace_back(t);
  }
  EXPECT_FALSE(expected.empty());
  EXPECT_LT(expected.size(), request_.mesh.tet_count() / 2);
  const std::vector<TetId> found = differing(shape);
  EXPECT_TRUE(std::includes(found.begin(), found.end(), expected.begin(), expected.end()));
}

TEST_F(LocalRitzTest, ARecordedBodyHasItsRecordedStiffness) {
  for (const TornState& state : recorded_) {
    for (const NodeId point : points()) {
      const Mat3 K = exact(state, point);
      EXPECT_LE((stiffness(state, point, differing(shape_of(state.body.mesh()))) - K).norm(), kRounding * K.norm())
          << "node " << point.value();
    }
  }
}

TEST_F(LocalRitzTest, WithTheWholeBodyInTheRegionItIsTheExactStiffness) {
  std::vector<TetId> all;
  for (std::size_t t = 0; t < request_.mesh.tet_count(); ++t) all.emplace_back(t);
  const TornState state = torn(70.0);
  for (const NodeId point : points()) {
    const Mat3 K = exact(state, point);
    EXPECT_LE((stiffness(state, point, all) - K).norm(), kRounding * K.norm()) << "node " << point.value();
  }
}

TEST_F(LocalRitzTest, BetweenRecordedBodiesItIsAnUpperBoundAndCloserThanTheirMeans) {
  for (const double angle : {66.0, 70.0, 75.0, 82.0}) {
    const TornState state = torn(angle);
    for (const NodeId point : points()) {
      const Mat3 K = exact(state, point);
      const Mat3 ritz = stiffness(state, point, differing(shape_of(state.body.mesh())));
      EXPECT_GE(Eigen::SelfAdjointEigenSolver<Mat3>(ritz - K).eigenvalues()[0], -kRounding * K.norm());
      const double part = (angle - 60.0) / 30.0;
      const Mat3 linear = (1.0 - part) * exact(recorded_[0], point) + part * exact(recorded_[1], point);
      EXPECT_LT((ritz - K).norm(), 0.3 * (linear - K).norm()) << angle << " degrees, node " << point.value();
    }
  }
}

}  // namespace
}  // namespace rhexis::response::test
