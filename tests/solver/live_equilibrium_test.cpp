#include "solver/live_equilibrium.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "mesh/generate.h"
#include "model/make_model.h"
#include "model/stabilisation.h"
#include "solver/equilibrium.h"
#include "tests/support/bodies.h"
#include "tests/support/model_names.h"

namespace rhexis {
namespace {

/// What frames at rest leave of the residual, relative; forces and places follow it.
constexpr double kSettled = 1e-6;

/// A bar of 40 x 40 x 120 mm, held below, in the hand at a node or inside a triangle of its side.
class LiveEquilibrium : public testing::TestWithParam<model::ModelKind> {
 protected:
  LiveEquilibrium() : mesh_(mesh::make_structured_box(Vec3(0.04, 0.04, 0.12), {3, 3, 9})) {
    model::ModelSettings settings;
    settings.kind = GetParam();
    settings.elastic = {1e5, 0.49};
    settings.law = material::to_mooney_rivlin(settings.elastic);
    settings.beta = model::auto_beta(settings.law);
    model_ = model::make_model(mesh_, settings);
    loading_ = test::no_load(*model_);
    test::clamp(loading_, mesh_, *model_, "-z");
    model::add_body_force(mesh_, model_->space(), Vec3(0.0, 0.0, -2000.0), loading_.dead_force);
  }

  std::int32_t node_at(const Vec3& x) const {
    std::int32_t nearest = 0;
    for (std::size_t i = 0; i < mesh_.node_count(); ++i)
      if ((mesh_.nodes[i] - x).norm() < (mesh_.node(NodeId(nearest)) - x).norm())
        nearest = static_cast<std::int32_t>(i);
    return nearest;
  }
  solver::HeldPoint at_node(std::int32_t node) const { return {{node, 0, 0}, Vec3::UnitX(), 1}; }
  solver::LiveEquilibrium live(solver::LiveOptions options = {.tolerance = kSettled}) const {
    return {model_, loading_, model_->initial_state(), options};
  }
  /// Until it is at rest.
  static void rest(solver::LiveEquilibrium& body, const Vec3& hand) {
    for (int frame = 0; frame < 200; ++frame) {
      const solver::LiveFrame report = body.step(hand);
      if (report.reached && report.residual <= kSettled && report.corrections == 0) return;
    }
    FAIL() << "not at rest after 200 frames";
  }
  /// The force that holds a node at `hand`, by Newton from `near`.
  Vec3 converged(model::State near, std::int32_t node, const Vec3& hand, model::State* at = nullptr) const {
    model::Loading held = loading_;
    for (std::int32_t c = 0; c < 3; ++c) held.supports.push_back({3 * node + c, hand[c]});
    std::sort(held.supports.begin(), held.supports.end(), [](const auto& a, const auto& b) { return a.dof < b.dof; });
    solver::Options options;
    options.steps = 1;
    options.tolerance = 1e-10;
    const solver::Report report = solver::solve_equilibrium(*model_, held, options, near);
    EXPECT_TRUE(report.converged()) << report.why;
    if (at != nullptr) *at = near;
    return report.reaction.segment<3>(3 * Eigen::Index{node});
  }

  mesh::TetMesh mesh_;
  std::shared_ptr<const model::Model> model_;
  model::Loading loading_;
};

TEST_P(LiveEquilibrium, AHandThatStaysFeelsTheConvergedForce) {
  const std::int32_t node = node_at(Vec3(0.04, 0.02, 0.12));
  solver::LiveEquilibrium body = live();
  body.hold(at_node(node));
  const Vec3 hand(0.012, 0.010, -0.004);
  for (int k = 1; k <= 20; ++k) body.step(k / 20.0 * hand);
  rest(body, hand);
  model::State at;
  const Vec3 force = converged(body.state(), node, hand, &at);
  EXPECT_LE((body.point() - hand).norm(), 1e-14);
  EXPECT_LE((body.force() - force).norm(), kSettled * force.norm());
  // The condition number stands between residual and place.
  EXPECT_LE((body.state().u - at.u).norm(), 1e-4 * at.u.norm());
}

TEST_P(LiveEquilibrium, TheForceOfAMovingHandIsRightToSecondOrder) {
  const std::int32_t node = node_at(Vec3(0.04, 0.02, 0.12));
  solver::LiveEquilibrium body = live({.corrections = 1, .tolerance = 0.0});
  body.hold(at_node(node));
  double worst = 0.0;
  double largest = 0.0;
  for (int k = 1; k <= 60; ++k) {  // 24 mm aside in one second
    const Vec3 hand(0.008 * std::sin(0.05 * k), 0.0004 * k, 0.0);
    const solver::LiveFrame frame = body.step(hand);
    ASSERT_TRUE(frame.trouble.empty()) << frame.trouble;
    if (k % 20 != 0 || !frame.reached) continue;
    const Vec3 force = converged(body.state(), node, hand);
    worst = std::max(worst, (body.force() - force).norm());
    largest = std::max(largest, force.norm());
  }
  EXPECT_GT(largest, 0.0);
  EXPECT_LT(worst, 0.02 * largest);
}

TEST_P(LiveEquilibrium, TheFirstGuessGoesAlongTheArcAndNotTheChord) {
  if (model_->allows_inversion()) GTEST_SKIP() << "this law goes along the chord";
  const std::int32_t node = node_at(Vec3(0.04, 0.02, 0.12));
  const Vec3 hand(0.0, 0.012, 0.0);
  const Vec3 move(0.0, 0.004, 0.0);
  model::State here = model_->initial_state();
  for (int k = 1; k <= 4; ++k) converged(here, node, k / 4.0 * hand, &here);
  // No correction, and Z to a millionth: what is left is the guess.
  const solver::LiveOptions only_guess{.corrections = 0, .iterations = 200, .late = 1e9, .worn_answer = 1e-6};
  const auto residual_of = [&](const model::State& state) {
    solver::LiveEquilibrium body(model_, loading_, state, only_guess);
    body.hold(at_node(node));
    return body.residual();
  };
  solver::LiveEquilibrium body(model_, loading_, here, only_guess);
  body.hold(at_node(node));
  for (int k = 0; k < 10; ++k) body.step(hand);
  body.step(hand + move);
  model::State before, after;
  constexpr double kPart = 0.01;
  converged(here, node, hand - kPart * move, &before);
  converged(here, node, hand + kPart * move, &after);
  model::State chord = here;
  chord.u += (after.u - before.u) / (2.0 * kPart);
  chord.lambda += (after.lambda - before.lambda) / (2.0 * kPart);
  EXPECT_LT(residual_of(here), 1e-9);
  // Three times nearer: what the straight step stretches the body by is gone, what the move strains it by is not.
  EXPECT_LT(body.residual(), 0.4 * residual_of(chord));
}

TEST_P(LiveEquilibrium, TheComplianceIsTheDerivativeOfTheConvergedForce) {
  const std::int32_t node = node_at(Vec3(0.04, 0.02, 0.12));
  solver::LiveEquilibrium body = live({.tolerance = 0.0, .worn_answer = 1e-4});
  body.hold(at_node(node));
  const Vec3 hand(0.0, 0.012, 0.0);
  for (int k = 1; k <= 20; ++k) body.step(k / 20.0 * hand);
  for (int k = 0; k < 40; ++k) body.step(hand);
  Mat3 derivative;
  constexpr double kMove = 1e-5;
  for (int c = 0; c < 3; ++c)
    derivative.col(c) = (converged(body.state(), node, hand + kMove * Vec3::Unit(c)) -
                         converged(body.state(), node, hand - kMove * Vec3::Unit(c))) /
                        (2.0 * kMove);
  EXPECT_LE((body.stiffness() - derivative).norm(), 2e-3 * derivative.norm());
  EXPECT_LE((body.stiffness() * body.compliance() - Mat3::Identity()).norm(), 1e-9);
}

TEST_P(LiveEquilibrium, APointInsideATriangleFollowsTheHand) {
  // Three nodes of one face of the side +x.
  const mesh::FaceSet* side = mesh_.find_face_set("+x");
  ASSERT_NE(side, nullptr);
  const auto nodes = mesh::face_nodes(mesh_, side->faces.back());
  const solver::HeldPoint point{{nodes[0].value(), nodes[1].value(), nodes[2].value()}, Vec3(0.5, 0.3, 0.2), 3};
  solver::LiveEquilibrium body = live();
  body.hold(point);
  const Vec3 hand(0.006, 0.004, 0.002);
  for (int k = 1; k <= 10; ++k) body.step(k / 10.0 * hand);
  rest(body, hand);
  EXPECT_LE((body.point() - hand).norm(), 1e-14);
  EXPECT_GT(body.force().dot(hand), 0.0);
  EXPECT_GT(body.compliance().determinant(), 0.0);
}

TEST_P(LiveEquilibrium, LetGoItComesBackToWhereItWas) {
  solver::LiveEquilibrium body = live();
  for (int k = 0; k < 50; ++k) body.settle();
  const VectorX before = body.state().u;
  const std::int32_t node = node_at(Vec3(0.0, 0.0, 0.12));
  body.hold(at_node(node));
  const Vec3 start = body.point();
  for (int k = 1; k <= 40; ++k) body.step(start + Vec3(0.0, -0.0004 * k, 0.0));
  body.let_go();
  for (int k = 0; k < 200; ++k) body.settle();
  EXPECT_LE((body.state().u - before).lpNorm<Eigen::Infinity>(), 1e-6 * 0.12);
}

TEST_P(LiveEquilibrium, AHandThatTearsAwayIsFollowedLateAndNeverWrong) {
  solver::LiveEquilibrium body = live({});
  body.hold(at_node(node_at(Vec3(0.04, 0.02, 0.12))));
  const Vec3 far(-0.05, 0.0, -0.08);
  bool late = false;
  for (int k = 0; k < 60; ++k) {
    const solver::LiveFrame frame = body.step(far);
    late = late || !frame.reached;
    ASSERT_TRUE(body.state().u.allFinite());
    ASSERT_TRUE(body.force().allFinite());
    const model::TetFields fields = model_->fields(body.state());
    if (!model_->allows_inversion()) {
      ASSERT_GT(*std::min_element(fields.J.begin(), fields.J.end()), 0.0) << k;
    }
  }
  EXPECT_TRUE(late);
}

INSTANTIATE_TEST_SUITE_P(Models, LiveEquilibrium,
                         testing::Values(model::ModelKind::corotated, model::ModelKind::geometrically_nonlinear,
                                         model::ModelKind::hyperelastic),
                         test::model_case_name);

}  // namespace
}  // namespace rhexis
