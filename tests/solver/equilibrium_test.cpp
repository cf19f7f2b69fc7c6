// How runs end: reports, cuts, failures that say why, determinism.

#include "solver/equilibrium.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/hash.h"
#include "base/parallel.h"
#include "mesh/generate.h"
#include "model/make_model.h"
#include "tests/support/bodies.h"

namespace rhexis {
namespace {

mesh::TetMesh bar() { return mesh::make_structured_box(Vec3(0.1, 0.1, 0.4), {2, 2, 8}); }

model::ModelSettings psh(double beta) {
  model::ModelSettings settings;
  settings.kind = model::ModelKind::hyperelastic;
  settings.law = material::to_mooney_rivlin({1e5, 0.49});
  settings.elastic = {1e5, 0.49};
  settings.beta = beta;
  return settings;
}

/// A cantilever along z under a density times g in -y.
model::Loading cantilever(const mesh::TetMesh& mesh, const model::Model& body, double weight) {
  model::Loading loading = test::no_load(body);
  test::clamp(loading, mesh, body, "-z");
  model::add_body_force(mesh, body.space(), Vec3(0, -weight, 0), loading.dead_force);
  return loading;
}

TEST(Equilibrium, ReportsEveryStepAndBalancesTheLoad) {
  const mesh::TetMesh mesh = bar();
  const auto body = model::make_model(mesh, psh(10));
  const model::Loading loading = cantilever(mesh, *body, 9810);
  model::State state = body->initial_state();
  std::vector<double> seen;
  const solver::Report report = solver::solve_equilibrium(
      *body, loading, {.steps = 5}, state, [&](const solver::StepReport& step, const model::State&, const VectorX&) {
        seen.push_back(step.load);
        return true;
      });
  ASSERT_TRUE(report.converged()) << report.why;
  EXPECT_EQ(seen.size(), report.steps.size());
  EXPECT_DOUBLE_EQ(seen.back(), 1.0);
  EXPECT_LE(report.residual_u, 1e-8);
  // The supports carry the weight: 0.004 m^3 * 9810 N/m^3, to the tolerance of the iteration.
  EXPECT_NEAR(test::total(report.reaction, *body, mesh, "-z", 1), 0.004 * 9810, 1e-6 * 39.24);
}

TEST(Equilibrium, NoLoadIsConvergedAtOnce) {
  const mesh::TetMesh mesh = bar();
  const auto body = model::make_model(mesh, psh(0));
  const model::Loading loading = cantilever(mesh, *body, 0);
  model::State state = body->initial_state();
  const solver::Report report = solver::solve_equilibrium(*body, loading, {.steps = 1}, state);
  EXPECT_TRUE(report.converged());
  // F = I is not exact in floating point where X is not; the body may move in the last place of its coordinates.
  EXPECT_LT(state.u.norm(), 1e-15);
}

TEST(Equilibrium, InitialLambdaDoesNotChangeTheAnswer) {
  const mesh::TetMesh mesh = bar();
  model::ModelSettings settings = psh(10);
  std::vector<VectorX> answers;
  for (const double start : {0.0, 300.0}) {
    settings.initial_lambda = start;
    const auto body = model::make_model(mesh, settings);
    model::State state = body->initial_state();
    ASSERT_TRUE(
        solver::solve_equilibrium(*body, cantilever(mesh, *body, 9810), {.tolerance = 1e-12}, state).converged());
    answers.push_back(state.u);
  }
  EXPECT_LT((answers[0] - answers[1]).norm(), 1e-9 * answers[0].norm());
}

TEST(Equilibrium, StVenantKirchhoffCollapsesInCompressionAndSaysWhere) {
  // St. Venant-Kirchhoff loses its stiffness at a stretch of 1/sqrt(3); pushed to a fifth, it has no answer of positive
  // J that bears the load.
  const mesh::TetMesh mesh = mesh::make_structured_box(Vec3::Constant(0.1), {3, 3, 3});
  model::ModelSettings settings = psh(0);
  settings.kind = model::ModelKind::geometrically_nonlinear;
  const auto body = model::make_model(mesh, settings);
  model::Loading loading = test::no_load(*body);
  test::clamp(loading, mesh, *body, "-z");
  model::add_traction(mesh, body->space(), mesh.find_face_set("+z")->faces, Vec3(0, 0, -3000), loading.dead_force);
  model::State state = body->initial_state();
  const solver::Report report =
      solver::solve_equilibrium(*body, loading, {.steps = 4, .max_iterations = 15, .max_cuts = 3}, state);
  if (report.converged()) {
    // A model that allows inversion may find an answer: then it has to be counted.
    double smallest = 1.0;
    for (const double J : body->fields(state).J) smallest = std::min(smallest, J);
    EXPECT_LT(smallest, 0.0);
  } else {
    EXPECT_THAT(report.why, testing::HasSubstr("at load fraction"));
    EXPECT_FALSE(report.cuts.empty());
    EXPECT_LT(report.load, 1.0);
  }
}

TEST(Equilibrium, CutsTheStepAndGoesOn) {
  const mesh::TetMesh mesh = bar();
  const auto body = model::make_model(mesh, psh(100));
  const model::Loading loading = cantilever(mesh, *body, 4 * 9810);
  model::State state = body->initial_state();
  // Six iterations are too few for the whole load at once.
  const solver::Report report = solver::solve_equilibrium(*body, loading, {.steps = 1, .max_iterations = 6}, state);
  ASSERT_TRUE(report.converged()) << report.why;
  EXPECT_FALSE(report.cuts.empty());
  EXPECT_GT(report.steps.size(), 1u);
}

TEST(Equilibrium, NamesTheTetWhoseForceIsNotFinite) {
  const mesh::TetMesh mesh = bar();
  const auto body = model::make_model(mesh, psh(0));
  model::State state = body->initial_state();
  state.u[3 * mesh.tets[7][2].value() + 1] = std::numeric_limits<double>::quiet_NaN();
  const solver::Report report = solver::solve_equilibrium(*body, cantilever(mesh, *body, 1), {.max_cuts = 1}, state);
  EXPECT_EQ(report.outcome, solver::Outcome::not_finite);
  EXPECT_THAT(report.why, testing::HasSubstr("is not finite"));
}

TEST(Equilibrium, StagnationAtRoundingCountsAsConvergedAndIsSaid) {
  const mesh::TetMesh mesh = bar();
  const auto body = model::make_model(mesh, psh(0));
  model::State state = body->initial_state();
  const solver::Report report =
      solver::solve_equilibrium(*body, cantilever(mesh, *body, 9810), {.tolerance = 1e-30}, state);
  EXPECT_TRUE(report.converged()) << report.why;
  EXPECT_EQ(report.outcome, solver::Outcome::stagnated);
  EXPECT_THAT(report.steps.back().message, testing::HasSubstr("rounding"));
  EXPECT_LT(report.residual_u, 1e-11);
}

TEST(Equilibrium, IterativeSolversAgreeWithDirect) {
  const mesh::TetMesh mesh = bar();
  for (const model::ModelKind kind :
       {model::ModelKind::corotated, model::ModelKind::hyperelastic, model::ModelKind::taylor_hood}) {
    model::ModelSettings settings = psh(10);
    settings.kind = kind;
    const auto body = model::make_model(mesh, settings);
    const model::Loading loading = cantilever(mesh, *body, 2000);
    std::vector<VectorX> answers;
    for (const std::string linear : {"direct", "cg", "minres"}) {
      model::State state = body->initial_state();
      const solver::Report report =
          solver::solve_equilibrium(*body, loading, {.linear = linear, .tolerance = 1e-9, .steps = 2}, state);
      ASSERT_TRUE(report.converged()) << body->name() << " " << linear << ": " << report.why;
      answers.push_back(state.u);
    }
    // The residual tolerance times the condition of the bar, in bending some 1e3.
    EXPECT_LT((answers[1] - answers[0]).norm(), 1e-6 * answers[0].norm()) << body->name();
    EXPECT_LT((answers[2] - answers[0]).norm(), 1e-6 * answers[0].norm()) << body->name();
  }
}

TEST(Equilibrium, SameBitsWhateverTheNumberOfThreads) {
  const mesh::TetMesh mesh = bar();
  std::vector<std::uint64_t> hashes;
  for (const int threads : {1, 2, 3}) {
    set_thread_count(threads);
    const auto body = model::make_model(mesh, psh(10));
    model::State state = body->initial_state();
    ASSERT_TRUE(solver::solve_equilibrium(*body, cantilever(mesh, *body, 9810), {.steps = 2}, state).converged());
    hashes.push_back(
        Hash().add(std::span<const double>(state.u.data(), static_cast<std::size_t>(state.u.size()))).value());
  }
  set_thread_count(0);
  EXPECT_EQ(hashes[0], hashes[1]);
  EXPECT_EQ(hashes[0], hashes[2]);
}

TEST(Equilibrium, FollowerPressureInflatesAClosedCavityInBalance) {
  // Pressure all around a cube compresses it: the mean stress is -p everywhere, whatever the shape.
  const mesh::TetMesh mesh = mesh::make_structured_box(Vec3::Constant(0.1), {2, 2, 2});
  const auto body = model::make_model(mesh, psh(0));
  model::Loading loading = test::no_load(*body);
  test::hold_symmetry(loading, mesh, *body);
  for (const std::string side : {"+x", "+y", "+z"})
    loading.pressures.push_back(
        model::make_follower_pressure(mesh, body->space(), mesh.find_face_set(side)->faces, 5e4, loading.supports));
  model::State state = body->initial_state();
  const solver::Report report = solver::solve_equilibrium(*body, loading, {.tolerance = 1e-11, .steps = 2}, state);
  ASSERT_TRUE(report.converged()) << report.why;
  for (const double lambda : state.lambda) EXPECT_NEAR(lambda, -5e4, 1e-8 * 5e4);
}

TEST(Equilibrium, TheObserverCanStopTheRun) {
  const mesh::TetMesh mesh = bar();
  const auto body = model::make_model(mesh, psh(10));
  model::State state = body->initial_state();
  const auto stop_at_once = [](const solver::StepReport&, const model::State&, const VectorX&) { return false; };
  const solver::Report report =
      solver::solve_equilibrium(*body, cantilever(mesh, *body, 9810), {.steps = 5}, state, stop_at_once);
  EXPECT_EQ(report.outcome, solver::Outcome::stopped);
  EXPECT_FALSE(report.converged());
  EXPECT_EQ(report.steps.size(), 1u);
  EXPECT_DOUBLE_EQ(report.load, 0.2);
  EXPECT_TRUE(  // who asks in the last step gets what the run would have given anyway
      solver::solve_equilibrium(*body, cantilever(mesh, *body, 9810), {.steps = 1}, state, stop_at_once).converged());
}

TEST(Equilibrium, CreepingUpToALimitPointEnds) {
  // A cube of springs pressed together past what they bear: steps fail, halve, succeed, double and fail.
  const mesh::TetMesh mesh = mesh::make_bar({Vec3::Constant(0.01)}, 200).value();
  model::ModelSettings settings = psh(0);
  settings.kind = model::ModelKind::mass_spring;
  const auto body = model::make_model(mesh, settings);
  model::Loading loading = test::no_load(*body);
  test::clamp(loading, mesh, *body, "-z");
  model::add_traction(mesh, body->space(), mesh.find_face_set("+z")->faces, Vec3(0, 0, -1e3), loading.dead_force);
  model::State state = body->initial_state();
  const solver::Options options{.steps = 5, .max_iterations = 10, .max_cuts = 4};
  const solver::Report report = solver::solve_equilibrium(*body, loading, options, state);
  EXPECT_LE(report.cuts.size(), 5u * 4u + 1u);
  for (const solver::StepReport& step : report.steps) EXPECT_GE(step.iterations, 1);
  if (!report.converged()) {
    EXPECT_THAT(report.why, testing::HasSubstr("at load fraction"));
  }
}

TEST(Equilibrium, NumbersTooFarApartAreNoConvergence) {
  const mesh::TetMesh mesh = bar();
  const auto body = model::make_model(mesh, psh(10));
  model::Loading loading = test::no_load(*body);
  test::clamp(loading, mesh, *body, "-z");
  test::hold(loading, mesh, *body, "+z", 2, 1e10);
  model::State state = body->initial_state();
  const solver::Report report = solver::solve_equilibrium(*body, loading, {.steps = 2, .max_cuts = 2}, state);
  if (report.converged()) {
    EXPECT_LT(report.residual_u, 1e-6);
  }
}

TEST(Equilibrium, AFreeRimIsRefusedByIterativeSolversWithoutCutting) {
  const mesh::TetMesh mesh = bar();
  const auto body = model::make_model(mesh, psh(10));
  model::Loading loading = test::no_load(*body);
  test::clamp(loading, mesh, *body, "-z");
  loading.pressures.push_back(
      model::make_follower_pressure(mesh, body->space(), mesh.find_face_set("+x")->faces, 100.0, loading.supports));
  model::State state = body->initial_state();
  const solver::Report report = solver::solve_equilibrium(*body, loading, {.linear = "cg"}, state);
  EXPECT_EQ(report.outcome, solver::Outcome::linear_solver);
  EXPECT_EQ(report.cuts.size(), 1u);
  EXPECT_THAT(report.why, testing::HasSubstr("free rim"));
  state = body->initial_state();
  EXPECT_TRUE(solver::solve_equilibrium(*body, loading, {.linear = "direct"}, state).converged());
}

}  // namespace
}  // namespace rhexis
