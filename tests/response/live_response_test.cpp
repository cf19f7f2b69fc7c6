#include "response/live_response.h"

#include <cmath>
#include <cstdlib>

#include "base/parallel.h"
#include "fracture/torn_body.h"
#include "mesh/generate.h"
#include "model/stabilisation.h"
#include "response/exact_response.h"
#include "tests/fracture/cut_support.h"
#include "tests/support/full_solve.h"
#include "tests/support/measured.h"
#include "tests/support/model_names.h"
#include "tests/support/random_draws.h"

namespace rhexis::response {
namespace {

using rhexis::test::FullSolve;

/// What moves at rest leave of the residual, relative; forces and places follow it.
constexpr double kSettled = 1e-7;

/// A soft bar of 100 x 40 x 40 mm, held at -x and cut from its upper side near the middle, step by step.
struct TornBar {
  explicit TornBar(model::ModelKind kind, fracture::IncisionMethod method = fracture::IncisionMethod::split,
                   double poisson = 0.45, const Vec3& gravity = Vec3(0.0, 0.0, -9.81))
      : cut(mesh::make_bar({{0.10, 0.04, 0.04}}, 260).value(), method) {
    cut.hold([](const Vec3& x) { return x[0] < 1e-9; });
    body.model.kind = kind;
    body.model.elastic = body.body.elastic = {1e5, poisson};
    body.model.law = material::to_mooney_rivlin(body.model.elastic);
    body.model.beta = model::auto_beta(body.model.law);
    body.body.density = 1000.0;
    body.body.gravity = gravity;
    for (std::size_t dof = 0; dof < cut.held.size(); ++dof) {
      if (cut.held[dof] != 0) body.body.supports.push_back({static_cast<std::int32_t>(dof), 0.0});
    }
  }
  std::unique_ptr<LiveResponse> response(int frames = 200, double tolerance = kSettled) const {
    Expected<std::unique_ptr<LiveResponse>> made = LiveResponse::make(
        cut.body,
        {.body = body, .live = {.tolerance = tolerance}, .frames = frames, .solver = {.tolerance = 1e-9, .steps = 2}});
    EXPECT_TRUE(made.has_value()) << made.error().message();
    return std::move(*made);
  }
  /// With mass, one frame a move.
  std::unique_ptr<LiveResponse> moving(double stiffness_damping = 0.002, double step = 0.016) const {
    Expected<std::unique_ptr<LiveResponse>> made = LiveResponse::make(
        cut.body,
        {.body = body,
         .solver = {.tolerance = 1e-9, .steps = 2},
         .dynamics = solver::Dynamics{
             .density = body.body.density, .mass_damping = 1.0, .stiffness_damping = stiffness_damping, .step = step}});
    EXPECT_TRUE(made.has_value()) << made.error().message();
    return std::move(*made);
  }
  /// The crack goes down by `depth` (m); the body takes it.
  mesh::MeshEdit step(double depth) {
    mesh::MeshEdit edit =
        cut.incise(fracture::test::strip({{0.052, -0.001, 0.041 - at}, {0.052, 0.041, 0.041 - at}},
                                         {{0.052, -0.001, 0.041 - at - depth}, {0.052, 0.041, 0.041 - at - depth}}))
            .edit;
    at += depth;
    cut.apply(edit);
    return cut.body.history().back();
  }
  SurfacePoint end() const {
    const std::optional<SurfacePoint> point = nearest_surface_point(cut.body, Vec3(0.10, 0.02, 0.04), 0.02);
    EXPECT_EQ(point->count, 1);
    return *point;
  }

  fracture::test::CutBody cut;
  LiveBody body;
  double at = 0.0;
};

Vec3 force_of(const LiveResponse& response, const SurfacePoint& point, const Vec3& hand,
              ContactMode mode = ContactMode::hold) {
  return make_contact_law(point, ContactRule::consistent, mode, response.compliance(), response.rest()).force(hand);
}

/// Until it is at rest.
void rest(LiveResponse& response, const Vec3& hand) {
  for (int k = 0; k < 40; ++k) {
    const MoveReport report = response.move(hand);
    if (report.at_rest) return;
  }
  FAIL() << "not at rest, residual " << response.residual();
}

class LiveResponseOf : public testing::TestWithParam<model::ModelKind> {};

TEST_P(LiveResponseOf, TheTornBodyFeelsAsTheFullSolveOfWhatIsLeft) {
  for (const auto method : {fracture::IncisionMethod::split, fracture::IncisionMethod::keep_nodes}) {
    TornBar bar(GetParam(), method);
    const auto response = bar.response();
    const SurfacePoint point = bar.end();
    response->hold(point, ContactMode::hold);
    const Vec3 start = response->rest().head<3>();
    const Vec3 by(0.004, 0.006, 0.010);
    for (int k = 1; k <= 10; ++k) response->move(start + k / 10.0 * by);
    for (int tears = 0; tears < 3; ++tears) {
      const mesh::MeshEdit edit = bar.step(0.008);
      ASSERT_FALSE(edit.empty());
      const FollowReport followed = response->follow(edit, {});
      ASSERT_TRUE(followed.ok) << followed.why;
      ASSERT_NO_FATAL_FAILURE(rest(*response, start + by));
      const FullSolve full(bar.cut.body, bar.body, response->state().u);
      const FullSolve::Held exact = full.held(point.node[0], start + by, full.state_of(response->state()));
      ASSERT_TRUE(exact.converged);
      const Vec3 force = force_of(*response, point, start + by);
      EXPECT_LE((force - exact.force).norm(), 1e-5 * exact.force.norm()) << tears;
      // The condition number stands between residual and place.
      EXPECT_LE((response->state().u - exact.state.u).norm(), 1e-4 * exact.state.u.norm()) << tears;
    }
    response->grasp({});
    ASSERT_NO_FATAL_FAILURE(rest(*response, Vec3::Zero()));
    const FullSolve full(bar.cut.body, bar.body, response->state().u);
    const FullSolve::Held exact = full.released(full.at_rest(), 4);
    ASSERT_TRUE(exact.converged);
    EXPECT_GT(exact.state.u.norm(), 0.0);
    EXPECT_LE((response->state().u - exact.state.u).norm(), 1e-4 * exact.state.u.norm());
  }
}

TEST_P(LiveResponseOf, TheLawIsTheDerivativeOfTheForceOfTheTornBody) {
  TornBar bar(GetParam());
  const auto response = bar.response();
  const SurfacePoint point = bar.end();
  response->hold(point, ContactMode::hold);
  const Vec3 hand = response->rest().head<3>() + Vec3(0.0, 0.004, 0.008);
  for (int k = 1; k <= 10; ++k) response->move(k / 10.0 * hand);
  ASSERT_TRUE(response->follow(bar.step(0.015), {}).ok);
  // One column of the compliance is brought up to date by each correction.
  for (int k = 0; k < 12; ++k) response->move(hand + Vec3(0.0, 0.0, k % 2 == 0 ? 1e-5 : 0.0));
  ASSERT_NO_FATAL_FAILURE(rest(*response, hand));
  const FullSolve full(bar.cut.body, bar.body, response->state().u);
  const model::State near = full.state_of(response->state());
  Mat3 derivative;
  constexpr double kMove = 1e-5;
  for (int c = 0; c < 3; ++c)
    derivative.col(c) = (full.held(point.node[0], hand + kMove * Vec3::Unit(c), near).force -
                         full.held(point.node[0], hand - kMove * Vec3::Unit(c), near).force) /
                        (2.0 * kMove);
  const ContactLaw law =
      make_contact_law(point, ContactRule::consistent, ContactMode::hold, response->compliance(), response->rest());
  EXPECT_GT(derivative.norm(), 0.0);
  EXPECT_LE((law.stiffness - derivative).norm(), 0.05 * derivative.norm());  // as far as a worn column goes
}

TEST_P(LiveResponseOf, UndoReturnsToTheBit) {
  TornBar bar(GetParam());
  const auto response = bar.response(1);
  const SurfacePoint point = bar.end();
  response->hold(point, ContactMode::hold);
  for (int k = 1; k <= 10; ++k) response->move(Vec3(0.0, 0.0, 0.001 * k));
  const model::State before = response->state();
  const mesh::MeshEdit edit = bar.step(0.01);
  ASSERT_TRUE(response->follow(edit, {}).ok);
  for (int k = 0; k < 5; ++k) response->move(Vec3(0.0, 0.0, 0.01));
  EXPECT_NE(response->state().u.head(before.u.size()), before.u);
  bar.cut.undo();
  response->go_back(edit, {});
  EXPECT_EQ(response->state().u, before.u);
  EXPECT_EQ(response->state().lambda, before.lambda);
  EXPECT_GT(response->compliance().norm(), 0.0);  // what was held is held
}

/// Frames of a millisecond.
void let_pass(LiveResponse& response, int frames, const Vec3& hand = Vec3::Zero()) {
  for (int k = 0; k < frames; ++k) {
    response.pass(1e-3);
    response.move(hand);
  }
}

TEST_P(LiveResponseOf, WithMassItIsLetGoTornAndSwingsToTheRestOfTheFullSolve) {
  TornBar bar(GetParam());
  const auto response = bar.moving();
  response->hold(bar.end(), ContactMode::hold);
  const Vec3 start = response->rest().head<3>();
  for (int k = 1; k <= 200; ++k) let_pass(*response, 1, start + k / 200.0 * Vec3(0.0, 0.01, 0.02));
  ASSERT_TRUE(response->follow(bar.step(0.015), {}).ok);
  let_pass(*response, 50, start + Vec3(0.0, 0.01, 0.02));
  response->grasp({});
  EXPECT_EQ(response->compliance().size(), 0);
  const Eigen::Index end = 3 * Eigen::Index{bar.end().node[0].value()} + 2;
  double lowest = response->state().u[end];
  double kinetic = 0.0;
  int frames = 0;
  for (MoveReport report{.at_rest = false}; !report.at_rest && frames < 20000; ++frames) {
    response->pass(1e-3);
    report = response->move(Vec3::Zero());
    lowest = std::min(lowest, response->state().u[end]);
    kinetic = std::max(kinetic, response->inertia().kinetic_energy(response->state().u));
  }
  EXPECT_LT(frames, 20000);
  const FullSolve full(bar.cut.body, bar.body, response->state().u);
  const FullSolve::Held exact = full.released(full.at_rest(), 4);
  ASSERT_TRUE(exact.converged);
  EXPECT_LE((response->state().u - exact.state.u).lpNorm<Eigen::Infinity>(), 1e-6 * 0.10);
  EXPECT_LT(lowest, exact.state.u[end] - 1e-3);  // it swung through
  EXPECT_GT(kinetic, 0.0);
}

TEST_P(LiveResponseOf, ATearKeepsMassAndMomentum) {
  TornBar bar(GetParam());
  const auto response = bar.moving();
  response->hold(bar.end(), ContactMode::hold);
  const Vec3 start = response->rest().head<3>();
  for (int k = 1; k <= 100; ++k) let_pass(*response, 1, start + k / 100.0 * Vec3(0.0, 0.01, 0.02));
  response->grasp({});
  let_pass(*response, 100);
  const auto momentum = [&] {
    const solver::Inertia& inertia = response->inertia();
    Vec3 sum = Vec3::Zero();
    for (Eigen::Index i = 0; i < inertia.mass().size(); ++i)
      sum += inertia.mass()[i] * inertia.motion().velocity.segment<3>(3 * i);
    return sum;
  };
  const double mass = response->inertia().mass().sum();
  const Vec3 before = momentum();
  const mesh::MeshEdit edit = bar.step(0.015);
  ASSERT_FALSE(edit.copied.empty());
  ASSERT_TRUE(response->follow(edit, {}).ok);
  EXPECT_NEAR(response->inertia().mass().sum(), mass, 1e-13 * mass);
  // Nodes that the incision moves in the reference configuration keep their velocity and take other shares of mass.
  EXPECT_LE((momentum() - before).norm(), 0.02 * before.norm());
  EXPECT_GT(before.norm(), 1e-3 * mass);
}

TEST_P(LiveResponseOf, UndoBringsTheMotionBackToo) {
  TornBar bar(GetParam());
  const auto response = bar.moving();
  const SurfacePoint point = bar.end();
  response->hold(point, ContactMode::hold);
  for (int k = 1; k <= 60; ++k) let_pass(*response, 1, Vec3(0.0, 0.0, 0.0003 * k));
  const model::State before = response->state();
  const VectorX velocity = response->inertia().motion().velocity;
  const VectorX from = response->inertia().motion().u;
  EXPECT_GT(velocity.norm(), 0.0);
  const mesh::MeshEdit edit = bar.step(0.01);
  ASSERT_TRUE(response->follow(edit, {}).ok);
  let_pass(*response, 60, Vec3(0.0, 0.0, 0.02));
  bar.cut.undo();
  response->go_back(edit, {});
  EXPECT_EQ(response->state().u, before.u);
  EXPECT_EQ(response->inertia().motion().velocity, velocity);
  EXPECT_EQ(response->inertia().motion().u, from);
}

TEST_P(LiveResponseOf, WithMassTheSameMovesGiveTheSameBitsWhateverTheThreads) {
  std::vector<VectorX> state;
  for (const int threads : {1, 2}) {
    set_thread_count(threads);
    TornBar bar(GetParam());
    const auto response = bar.moving();
    response->hold(bar.end(), ContactMode::hold);
    for (int k = 1; k <= 120; ++k) {
      let_pass(*response, 1, Vec3(0.0001 * k, 0.0, 0.00015 * k));
      if (k % 40 == 0) {
        ASSERT_TRUE(response->follow(bar.step(0.005), {}).ok);
      }
    }
    response->grasp({});
    let_pass(*response, 100);
    state.push_back(response->state().u);
  }
  set_thread_count(0);
  EXPECT_EQ(state[0], state[1]);
}

TEST_P(LiveResponseOf, TheSameMovesGiveTheSameBitsWhateverTheThreads) {
  std::vector<VectorX> state;
  for (const int threads : {1, 2}) {
    set_thread_count(threads);
    TornBar bar(GetParam());
    const auto response = bar.response(1, 1e-4);
    response->hold(bar.end(), ContactMode::hold);
    for (int k = 1; k <= 60; ++k) {
      response->move(Vec3(0.0002 * k, 0.0, 0.0003 * k));
      if (k % 15 == 0) {
        ASSERT_TRUE(response->follow(bar.step(0.005), {}).ok);
      }
    }
    state.push_back(response->state().u);
  }
  set_thread_count(0);
  EXPECT_EQ(state[0], state[1]);
}

TEST_P(LiveResponseOf, WhatIsPushedSlidesAsideUntilItFeelsTheNormalAlone) {
  TornBar bar(GetParam());
  const auto response = bar.response();
  SurfacePoint point = bar.end();
  point.normal = Vec3(0.0, 0.6, 0.8);
  response->hold(point, ContactMode::push);
  const Vec3 start = response->rest().head<3>();
  const Vec3 pressed = start - 0.006 * point.normal;
  for (int k = 1; k <= 10; ++k) response->move(start - 0.0006 * k * point.normal);
  for (int k = 0; k < 10; ++k) response->move(pressed);
  const Vec3 force = force_of(*response, point, pressed, ContactMode::push);
  EXPECT_LT(force.dot(point.normal), 0.0);
  EXPECT_LT((force - force.dot(point.normal) * point.normal).norm(), 1e-12 * force.norm());
  // The law starts from where the loads alone have the point; it is the point's own force that has to be normal too.
  EXPECT_LT((response->state().u.segment<3>(3 * point.node[0].value()) - pressed).dot(point.normal), 1e-7);
  // Taken away, it lies at rest again.
  for (int k = 0; k < 40; ++k) response->move(start + 0.01 * point.normal);
  EXPECT_EQ(force_of(*response, point, start + 0.01 * point.normal, ContactMode::push), Vec3::Zero());
  EXPECT_LT((response->state().u.segment<3>(3 * point.node[0].value()) - start).norm(), 1e-6);
}

/// RHEXIS_DRIFT_PULLS asks for more: 1,500 are ten minutes at 60 frames a second.
int drift_pulls() {
  const char* asked = std::getenv("RHEXIS_DRIFT_PULLS");
  return asked != nullptr ? std::atoi(asked) : 30;
}

TEST_P(LiveResponseOf, PulledAtForLongItComesBackToRest) {
  TornBar bar(GetParam());
  const auto response = bar.response(1, 1e-4);  // one frame a move, to the tolerance of a frame
  for (int k = 0; k < 20; ++k) response->move(Vec3::Zero());
  const VectorX before = response->state().u;
  const SurfacePoint point = bar.end();
  test::RandomDraws draws(1);
  for (int pull = 0; pull < drift_pulls(); ++pull) {
    response->hold(point, ContactMode::hold);
    const Vec3 start = response->rest().head<3>();
    const Vec3 by = draws.uniform(0.005, 0.03) * draws.direction();
    for (int k = 1; k <= 12; ++k) response->move(start + k / 12.0 * by);
    response->grasp({});
    for (int k = 0; k < 12; ++k) response->move(Vec3::Zero());
  }
  for (int k = 0; k < 60 && !response->move(Vec3::Zero()).at_rest; ++k) {
  }
  const double off = (response->state().u - before).lpNorm<Eigen::Infinity>() / 0.10;
  test::measured("{} pulls: back to {:.1e} of its length", drift_pulls(), off);
  EXPECT_LE(off, 1e-6);
}

/// Time goes in ticks of a millisecond, the body in steps of h: the force of a hand that goes on goes on too.
TEST_P(LiveResponseOf, TheForceOfASteadyPullWithMassIsNoSaw) {
  const auto forces = [](double h) {
    TornBar bar(GetParam());
    const auto response = bar.moving(0.02, h);
    const SurfacePoint point = bar.end();
    response->hold(point, ContactMode::hold);
    const Vec3 start = response->rest().head<3>();
    std::vector<Vec3> out;
    for (int k = 1; k <= 600; ++k) {
      const Vec3 hand = start + 2e-5 * k * Vec3(0.6, 0.0, 0.8);  // 20 mm/s
      response->pass(1e-3);
      response->move(hand);
      out.push_back(force_of(*response, point, hand));
    }
    return out;
  };
  const std::vector<Vec3> fine = forces(1e-3);
  for (const double h : {0.004, 0.016}) {
    const std::vector<Vec3> now = forces(h);
    double kink = 0.0;
    double off = 0.0;
    for (std::size_t k = 400; k < now.size(); ++k) {
      kink = std::max(kink, (now[k] - 2.0 * now[k - 1] + now[k - 2]).norm() / now[k].norm());
      off = std::max(off, (now[k] - fine[k]).norm() / fine[k].norm());
    }
    test::measured("h = {} s: kinks of {:.1e} of the force, {:.1e} from steps of 1 ms", h, kink, off);
    // The force bends as the body stretches, which a step foresees to first order: that is of the order of h^2. What is
    // felt of damping alone is 3% of the force with the longer step.
    EXPECT_LT(kink, 2e-3);
    EXPECT_LT(off, 2e-3);
  }
}

TEST_P(LiveResponseOf, SmallPullsFeelAsSmallStrains) {
  TornBar bar(GetParam(), fracture::IncisionMethod::split, 0.3, Vec3::Zero());
  bar.step(0.02);
  const auto response = bar.response();
  const SurfacePoint point = bar.end();
  response->hold(point, ContactMode::hold);
  const Vec3 hand(1e-6, 2e-6, 3e-6);
  ASSERT_NO_FATAL_FAILURE(rest(*response, hand));
  const Vec3 force = force_of(*response, point, hand);
  const auto linear = ExactResponse::make(bar.cut.body, {.body = bar.body.body}, {});
  linear->grasp({point.node.data(), 1});
  const Vec3 small =
      make_contact_law(point, ContactRule::consistent, ContactMode::hold, linear->compliance(), linear->rest())
          .force(hand);
  EXPECT_GT(small.norm(), 0.0);
  // The mixed element is another discretisation of the same small strains, a softer one.
  const double tolerance = GetParam() == model::ModelKind::hyperelastic ? 0.15 : 1e-3;
  EXPECT_LT((force - small).norm(), tolerance * small.norm());
}

TEST_P(LiveResponseOf, APointOnASupportIsNotHeld) {
  TornBar bar(GetParam());
  const auto response = bar.response();
  const std::optional<SurfacePoint> point = nearest_surface_point(bar.cut.body, Vec3(0.0, 0.02, 0.02));
  response->hold(*point, ContactMode::hold);
  EXPECT_EQ(response->compliance().norm(), 0.0);
  EXPECT_TRUE(response->move(Vec3::Zero()).near);
}

INSTANTIATE_TEST_SUITE_P(Models, LiveResponseOf,
                         testing::Values(model::ModelKind::corotated, model::ModelKind::geometrically_nonlinear,
                                         model::ModelKind::hyperelastic),
                         rhexis::test::model_case_name);

}  // namespace
}  // namespace rhexis::response
