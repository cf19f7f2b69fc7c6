// What every response promises, whatever it knows.

#include <Eigen/Eigenvalues>

#include "tests/response/recorded_case.h"

namespace rhexis::response::test {
namespace {

/// By name: "exact", "recorded"; of the loaded plate, torn once straight on and once to the side.
class ResponseContract : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    response_ = std::string(GetParam()) == "exact" ? plate_.exact(body()) : plate_.recorded(body(), {});
    ASSERT_NE(response_, nullptr);
    held_ = point_at(body(), {0.031, 0.113, 0.01});
    ASSERT_EQ(held_.count, 3);
    response_->grasp(nodes_of(held_));
  }
  void advance(double degrees) {
    const CrackAdvance made = plate_.advance(degrees, 0.035);
    const std::size_t before = body().history().size();
    torn_.advance(made.direction, made.length);
    ASSERT_EQ(body().history().size(), before + 1);
    const FollowReport report = response_->follow(body().history().back(), {}, &made);
    ASSERT_TRUE(report.ok);
  }
  [[nodiscard]] const mesh::TornMesh& body() const { return torn_.body.mesh(); }
  [[nodiscard]] std::vector<NodeId> all_nodes() const {
    std::vector<NodeId> out;
    for (std::size_t i = 0; i < body().mesh().node_count(); ++i) out.emplace_back(i);
    return out;
  }

  const RecordedCase& plate_ = RecordedCase::plate(true);
  record::build::TornState torn_ = plate_.torn(0);
  std::unique_ptr<Response> response_;
  SurfacePoint held_;
  VectorX force_ = VectorX::LinSpaced(9, -0.4, 0.7);
};
INSTANTIATE_TEST_SUITE_P(Every, ResponseContract, testing::Values("exact", "recorded"),
                         [](const auto& tested) { return std::string(tested.param); });

TEST_P(ResponseContract, ComplianceIsSymmetricAndPositiveAndGrowsAsTheBodyTears) {
  double soft = 0.0;
  for (const double degrees : {90.0, 140.0, 0.0}) {
    const Eigen::MatrixXd& C = response_->compliance();
    EXPECT_LT((C - C.transpose()).norm(), 1e-12 * C.norm());
    EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(C).eigenvalues().minCoeff(), 0.0);
    EXPECT_GE(C.trace(), soft);
    soft = C.trace();
    if (degrees > 0.0) advance(degrees);
  }
}

TEST_P(ResponseContract, DisplacementIsLinearAndAgreesAtTheHand) {
  for (const double degrees : {90.0, 140.0, 0.0}) {
    VectorX whole;
    response_->whole_displacement(force_, 1.0, whole);
    VectorX same;
    response_->displacement(all_nodes(), force_, 1.0, same);
    EXPECT_LT((whole - same).norm(), 1e-12 * whole.norm());
    VectorX loads;
    response_->whole_displacement(VectorX::Zero(9), 1.0, loads);
    VectorX hand;
    response_->whole_displacement(2.0 * force_, 0.0, hand);
    EXPECT_LT((whole - loads - 0.5 * hand).norm(), 1e-11 * whole.norm());
    EXPECT_GT(loads.norm(), 0.0);
    EXPECT_GT(hand.norm(), 0.0);
    VectorX at_hand;
    response_->displacement(nodes_of(held_), force_, 1.0, at_hand);
    EXPECT_LT((at_hand - response_->rest() - response_->compliance() * force_).norm(), 1e-10 * at_hand.norm());
    for (const model::PrescribedDof& support : plate_.request.elastic.supports)
      EXPECT_NEAR(whole[support.dof], support.value, 1e-15);
    if (degrees > 0.0) advance(degrees);
  }
}

TEST_P(ResponseContract, StoredEnergyIsTheWorkOfTheHand) {
  const double rest = response_->stored_energy(VectorX::Zero(9));
  EXPECT_NEAR(rest, 0.0, 1e-14);
  EXPECT_NEAR(response_->stored_energy(force_) - rest, 0.5 * force_.dot(response_->compliance() * force_), 1e-12);
  advance(90.0);
  EXPECT_LT(response_->stored_energy(VectorX::Zero(9)), rest);  // a softer body hangs lower
}

TEST_P(ResponseContract, GoesBackToWhereItWas) {
  const Eigen::MatrixXd first = response_->compliance();
  const VectorX rest = response_->rest();
  advance(90.0);
  const Eigen::MatrixXd second = response_->compliance();
  EXPECT_GT((second - first).norm(), 1e-6 * first.norm());
  advance(140.0);
  for (const Eigen::MatrixXd* before : {&second, &first}) {
    response_->go_back(torn_.body.undo(), {});
    EXPECT_LT((response_->compliance() - *before).norm(), 1e-11 * before->norm());
  }
  EXPECT_LT((response_->rest() - rest).norm(), 1e-11 * rest.norm());
}

TEST_P(ResponseContract, HoldsNothingWhenTheHandLetsGo) {
  response_->grasp({});
  EXPECT_EQ(response_->compliance().size(), 0);
  VectorX u;
  response_->whole_displacement({}, 1.0, u);
  EXPECT_GT(u.norm(), 0.0);
  advance(90.0);
  EXPECT_GT(response_->memory_bytes(), 1000U);
}

}  // namespace
}  // namespace rhexis::response::test
