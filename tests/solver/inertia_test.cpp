#include "solver/inertia.h"

#include <gtest/gtest.h>

#include <cmath>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "mesh/generate.h"
#include "model/make_model.h"
#include "model/stabilisation.h"
#include "solver/equilibrium.h"
#include "solver/live_equilibrium.h"
#include "tests/support/bodies.h"
#include "tests/support/model_names.h"

namespace rhexis {
namespace {

constexpr double kDensity = 1000.0;
constexpr double kHeight = 0.12;
const Vec3 kGravity(0.0, 0.0, -9.81);

/// A bar of 40 x 40 x 120 mm, held below or free.
class Moving : public testing::TestWithParam<model::ModelKind> {
 protected:
  Moving() : mesh_(mesh::make_structured_box(Vec3(0.04, 0.04, kHeight), {2, 2, 6})) {
    model::ModelSettings settings;
    settings.kind = GetParam();
    settings.elastic = {2e4, 0.45};
    settings.law = material::to_mooney_rivlin(settings.elastic);
    settings.beta = model::auto_beta(settings.law);
    model_ = model::make_model(mesh_, settings);
    free_ = held_ = test::no_load(*model_);
    test::clamp(held_, mesh_, *model_, "-z");
  }

  /// Every frame to the end of its step, as nearly as it gets there.
  static solver::LiveOptions exactly() {
    return {.corrections = 40, .tolerance = 1e-9, .at_rest = 1e-9, .forcing = 1e-2, .iterations = 60};
  }
  static solver::Dynamics dynamics(double a = 0.0, double b = 0.0, double h = 0.016) { return {kDensity, a, b, h}; }
  /// Ends the step under way, which is the first one after the start, and begins and ends the next.
  static void step(solver::LiveEquilibrium& body) {
    end(body);
    ASSERT_TRUE(body.begin_step());
    end(body);
  }
  static void end(solver::LiveEquilibrium& body) {
    for (int k = 0; k < 10 && body.residual() > 1e-9; ++k) body.settle();
    ASSERT_LE(body.residual(), 1e-9);
  }
  double energy(const solver::LiveEquilibrium& body) const {
    return model_->energy(body.state()) - body.loading().dead_force.dot(body.state().u) +
           body.inertia().kinetic_energy(body.state().u);
  }
  static Vec3 momentum(const solver::LiveEquilibrium& body) {
    const solver::Inertia& inertia = body.inertia();
    Vec3 sum = Vec3::Zero();
    for (Eigen::Index i = 0; i < inertia.mass().size(); ++i)
      sum += inertia.mass()[i] * (body.state().u.segment<3>(3 * i) - inertia.motion().u.segment<3>(3 * i)) /
             inertia.step();
    return sum;
  }
  /// Bent aside and stretched by the hand, then let go.
  std::unique_ptr<solver::LiveEquilibrium> bent(const model::Loading& loading, const solver::Dynamics& dynamics,
                                                solver::LiveOptions options) const {
    auto body = std::make_unique<solver::LiveEquilibrium>(model_, loading, model_->initial_state(), options, dynamics);
    std::int32_t top = 0;
    for (std::size_t i = 0; i < mesh_.node_count(); ++i) {
      const Vec3& x = mesh_.nodes[i];
      if (x[0] > 0.039 && x[2] > 0.119 && std::abs(x[1] - 0.02) < 1e-9) top = static_cast<std::int32_t>(i);
    }
    body->hold({{top, 0, 0}, Vec3::UnitX(), 1});
    for (int k = 1; k <= 60; ++k) {
      const double part = std::min(1.0, k / 30.0);
      body->begin_step();
      for (int frame = 0; frame < 3; ++frame) body->step(part * Vec3(0.05, 0.01, -0.01));
    }
    body->let_go();
    return body;
  }

  mesh::TetMesh mesh_;
  std::shared_ptr<const model::Model> model_;
  model::Loading free_, held_;
};

TEST_P(Moving, TheMassIsThatOfTheVolume) {
  const solver::Inertia inertia(dynamics(), *model_, VectorX::Zero(3 * Eigen::Index(mesh_.node_count())));
  // As many sums of 2^-53 as there are corners.
  EXPECT_NEAR(inertia.mass().sum(), kDensity * 0.04 * 0.04 * kHeight, 1e-13);
  EXPECT_GT(inertia.mass().minCoeff(), 0.0);
}

/// Of the first mode of the modal solution, q'' + (a + b w^2) q' + w^2 q = 0, backward Euler makes
/// q (1 + h^2 w^2 + h (a + b w^2)) = q_n (1 + h (a + b w^2)) + h v_n, v = (q - q_n) / h.
TEST_P(Moving, ASmallSwingIsTheModalSolutionStepByStep) {
  const model::State rest = model_->initial_state();
  linalg::SaddleMatrix K = model_->make_tangent();
  model_->tangent(rest, *model_->make_scratch(), K);
  const Eigen::Index n = rest.u.size();
  const Eigen::Index m = rest.lambda.size();
  Eigen::MatrixXd whole(n + m, n + m);
  VectorX u(n);
  VectorX lambda(m);
  for (Eigen::Index j = 0; j < n + m; ++j) {
    const VectorX unit = VectorX::Unit(n + m, j);
    K.multiply(unit.head(n), unit.tail(m), u, lambda);
    whole.col(j) << u, lambda;
  }
  Eigen::MatrixXd A = whole.topLeftCorner(n, n);
  Eigen::MatrixXd C_inverse_Bt(m, n);
  if (m > 0) {
    C_inverse_Bt = (-whole.bottomRightCorner(m, m)).ldlt().solve(whole.bottomLeftCorner(m, n));
    A += whole.topRightCorner(n, m) * C_inverse_Bt;
  }
  const solver::Inertia inertia(dynamics(), *model_, rest.u);
  const linalg::FreeDofs dofs = model::free_dofs(model_->space(), held_);
  Eigen::MatrixXd K_free(dofs.count(), dofs.count());
  VectorX M_free(dofs.count());
  for (Eigen::Index i = 0; i < dofs.count(); ++i) {
    const std::int32_t row = dofs.dof[static_cast<std::size_t>(i)];
    M_free[i] = inertia.mass()[row / 3];
    for (Eigen::Index j = 0; j < dofs.count(); ++j) K_free(i, j) = A(row, dofs.dof[static_cast<std::size_t>(j)]);
  }
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> modes(K_free, M_free.asDiagonal().toDenseMatrix());
  const double square = modes.eigenvalues()[0];
  VectorX mode = VectorX::Zero(n);
  for (Eigen::Index i = 0; i < dofs.count(); ++i)
    mode[dofs.dof[static_cast<std::size_t>(i)]] = modes.eigenvectors()(i, 0);
  mode /= mode.lpNorm<Eigen::Infinity>();

  for (const auto& [a, b] : {std::pair(0.0, 0.0), std::pair(3.0, 0.0), std::pair(0.0, 0.004)}) {
    const double h = 0.02 * 2.0 * EIGEN_PI / std::sqrt(square);
    const double amplitude = 1e-6 * kHeight;  // strains are that small, and so is what is not linear
    model::State start = rest;
    start.u += amplitude * mode;
    if (m > 0) start.lambda += C_inverse_Bt * (amplitude * mode);
    solver::LiveOptions options = exactly();
    options.tolerance = options.at_rest = 1e-10;  // the scale is of moves of a thousandth of the body
    solver::LiveEquilibrium body(model_, held_, start, options, dynamics(a, b, h));
    double q = amplitude;
    double v = 0.0;
    double largest_swing = 0.0;
    for (int k = 0; k < 100; ++k) {  // two periods
      ASSERT_TRUE(k == 0 || body.begin_step()) << k << ' ' << body.residual();
      for (int frame = 0; frame < 10 && body.residual() > 1e-10; ++frame) body.settle();
      const double damping = h * (a + b * square);
      const double next = (q * (1.0 + damping) + h * v) / (1.0 + h * h * square + damping);
      v = (next - q) / h;
      q = next;
      largest_swing = std::max(largest_swing, -q);
      ASSERT_LE((body.state().u - q * mode).lpNorm<Eigen::Infinity>(), 2e-5 * amplitude) << k << ' ' << a << ' ' << b;
    }
    EXPECT_GT(largest_swing, 0.3 * amplitude);
  }
}

TEST_P(Moving, AFreeBodyKeepsItsMomentumAndFallsAsItsWeightSays) {
  for (const double weight : {0.0, kDensity}) {
    model::Loading loading = free_;
    model::add_body_force(mesh_, model_->space(), weight * kGravity, loading.dead_force);
    solver::LiveEquilibrium body(model_, loading, model_->initial_state(), exactly(), dynamics(0.0, 0.002));
    solver::Motion motion = body.inertia().motion();
    for (Eigen::Index i = 0; i < motion.u.size() / 3; ++i) {  // turned, stretched and thrown
      const Vec3& x = mesh_.nodes[static_cast<std::size_t>(i)];
      motion.velocity.segment<3>(3 * i) =
          Vec3(0.3, 0.1, 0.2) + Vec3(2.0, 1.0, 3.0).cross(x) + Vec3(0.0, 0.0, 2.0 * x[2]);
    }
    Vec3 expected = Vec3::Zero();
    for (Eigen::Index i = 0; i < body.inertia().mass().size(); ++i)
      expected += body.inertia().mass()[i] * motion.velocity.segment<3>(3 * i);
    body.set_motion(motion);
    const double mass = body.inertia().mass().sum();
    for (int k = 0; k < 30; ++k) {
      ASSERT_TRUE(k == 0 || body.begin_step());
      for (int frame = 0; frame < 10 && body.residual() > 1e-9; ++frame) body.settle();
      expected += weight / kDensity * mass * kGravity * body.inertia().step();
      // What a step leaves of its residual is impulse.
      ASSERT_LE((momentum(body) - expected).norm(), 1e-9 * mass) << k;
    }
  }
}

TEST_P(Moving, TheHandGivesAFreeBodyItsMomentum) {
  for (const double b : {0.0, 0.01}) {
    solver::LiveOptions options = exactly();
    options.tolerance = 1e-10;  // what it leaves of a residual is left in the force
    solver::LiveEquilibrium body(model_, free_, model_->initial_state(), options, dynamics(0.5, b));
    body.hold({{0, 0, 0}, Vec3::UnitX(), 1});
    Vec3 before = Vec3::Zero();
    for (int k = 1; k <= 20; ++k) {
      ASSERT_TRUE(body.begin_step());
      const Vec3 hand = 1e-4 * k * k * Vec3(1.0, 0.5, 0.25);
      for (int frame = 0; frame < 10; ++frame) body.step(hand);
      const Vec3 rate = (momentum(body) - before) / body.inertia().step() + 0.5 * momentum(body);
      EXPECT_LE((body.force() - rate).norm(), 1e-7 * rate.norm()) << k;
      EXPECT_GT(rate.norm(), 0.0);
      before = momentum(body);
    }
  }
}

TEST_P(Moving, ASwingOfAThirdOfTheBodyOnlyLosesEnergy) {
  for (const double weight : {0.0, kDensity}) {
    model::Loading loading = held_;
    model::add_body_force(mesh_, model_->space(), 0.1 * weight * kGravity, loading.dead_force);
    const std::unique_ptr<solver::LiveEquilibrium> live = bent(loading, dynamics(), exactly());
    solver::LiveEquilibrium& body = *live;
    double before = energy(body);
    const double first = before;
    double kinetic = 0.0;
    for (int k = 0; k < 60; ++k) {
      ASSERT_NO_FATAL_FAILURE(step(body));
      if (k == 0) before = energy(body);  // of the first step that no hand has a part in
      const double now = energy(body);
      ASSERT_LE(now, before + 1e-9 * std::abs(first)) << k;
      before = now;
      kinetic = std::max(kinetic, body.inertia().kinetic_energy(body.state().u));
    }
    EXPECT_GT(kinetic, 0.05 * std::abs(first));
  }
}

TEST_P(Moving, ItComesToRestWhereTheStaticBodyRests) {
  model::Loading loading = held_;
  model::add_body_force(mesh_, model_->space(), kDensity * kGravity, loading.dead_force);
  const std::unique_ptr<solver::LiveEquilibrium> live = bent(loading, dynamics(2.0, 0.004), solver::moving({}));
  solver::LiveEquilibrium& body = *live;
  int steps = 0;
  for (; steps < 1000 && (body.moves() || body.residual() > 1e-7); ++steps) {
    body.begin_step();
    body.settle();
  }
  EXPECT_LT(steps, 1000);
  model::State exact = model_->initial_state();
  solver::Options options;
  options.tolerance = 1e-10;
  ASSERT_TRUE(solver::solve_equilibrium(*model_, loading, options, exact).converged());
  EXPECT_GT(exact.u.lpNorm<Eigen::Infinity>(), 1e-2 * kHeight);
  EXPECT_LE((body.state().u - exact.u).lpNorm<Eigen::Infinity>(), 1e-6 * kHeight);
}

TEST_P(Moving, AStepThatIsLateGoesOnAndAddsNoEnergy) {
  const std::unique_ptr<solver::LiveEquilibrium> live = bent(held_, dynamics(), solver::moving({}));
  solver::LiveEquilibrium& body = *live;
  solver::LiveEquilibrium slow(model_, held_, body.state(),
                               {.tolerance = 1e-6, .at_rest = 1e-6, .forcing = 0.5, .iterations = 1}, dynamics());
  double before = energy(slow);
  const double first = before;
  int late = 0;
  for (int frame = 0; frame < 300; ++frame) {
    const VectorX start = slow.inertia().motion().u;
    if (!slow.begin_step()) {
      ++late;
      EXPECT_EQ(slow.inertia().motion().u, start);
    }
    slow.settle();
    if (slow.residual() <= 1e-6) {
      EXPECT_LE(energy(slow), before + 1e-5 * first) << frame;
      before = energy(slow);
    }
  }
  EXPECT_GT(late, 0);
}

/// What cannot be followed is told, and the body moves on with the point where it is. Laws that have an answer for tets
/// inside out follow, to where there may be no equilibrium: all that is asked of them is numbers.
TEST_P(Moving, AHandThatCannotBeFollowedDoesNotStopTime) {
  const std::unique_ptr<solver::LiveEquilibrium> live = bent(held_, dynamics(), solver::moving({}));
  solver::LiveEquilibrium& body = *live;
  const std::int32_t middle = static_cast<std::int32_t>(mesh_.node_count() / 2);
  body.hold({{middle, 0, 0}, Vec3::UnitX(), 1});
  const Vec3 away = body.point() + Vec3(5.0, 0.0, -3.0);  // across the body, many times its size
  int steps = 0;
  int told = 0;
  for (int frame = 0; frame < 200; ++frame) {
    steps += body.begin_step() ? 1 : 0;
    const solver::LiveFrame now = body.step(away);
    told += now.reached ? 0 : 1;
    ASSERT_TRUE(body.state().u.allFinite() && body.force().allFinite());
    ASSERT_TRUE(model_->allows_inversion() || body.inverted_tets() == 0);
  }
  if (model_->allows_inversion()) return;
  EXPECT_GE(steps, 5);
  EXPECT_GT(told, 0);
}

/// One that cannot end is halted where it began, not in a state of a step before, however far from equilibrium all its
/// states were; and it goes on from there.
TEST_P(Moving, AStepThatDoesNotEndIsHaltedWhereItBegan) {
  for (const double late : {1e-30, 0.1}) {  // no state is near; those at the end of a step are
    solver::LiveOptions options = exactly();
    options.late = late;
    const std::unique_ptr<solver::LiveEquilibrium> live = bent(held_, dynamics(), options);
    solver::LiveEquilibrium& body = *live;
    for (int k = 0; k < 5; ++k) ASSERT_NO_FATAL_FAILURE(step(body));
    ASSERT_TRUE(body.begin_step());
    const VectorX began = body.state().u;
    EXPECT_EQ(body.inertia().motion().u, began);
    const double energy_then = energy(body);
    solver::Motion motion = body.inertia().motion();
    motion.velocity.setConstant(1e200);
    body.set_motion(motion);
    solver::LiveFrame frame;
    int frames = 0;
    for (; frames < 100 && !frame.gave_up; ++frames) {
      EXPECT_FALSE(body.begin_step());
      frame = body.settle();
    }
    ASSERT_TRUE(frame.gave_up);
    EXPECT_GT(frames, 20);
    EXPECT_EQ(frame.trouble, "a time step does not end: the motion is taken out of the body");
    EXPECT_EQ(body.state().u, began);
    EXPECT_EQ(body.inertia().momentum(began), 0.0);
    EXPECT_LE(energy(body), energy_then);
    for (int k = 0; k < 3; ++k) ASSERT_NO_FATAL_FAILURE(step(body));
    EXPECT_GT(body.inertia().kinetic_energy(body.state().u), 0.0);
    EXPECT_LE(energy(body), energy_then);
  }
}

INSTANTIATE_TEST_SUITE_P(Models, Moving,
                         testing::Values(model::ModelKind::corotated, model::ModelKind::geometrically_nonlinear,
                                         model::ModelKind::hyperelastic),
                         test::model_case_name);

}  // namespace
}  // namespace rhexis
