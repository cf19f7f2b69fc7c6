// Energy -> residual -> tangent by differences, for every model, law and beta; what holds without any reference.

#include <gtest/gtest.h>

#include "element/linear_tet.h"
#include "tests/model/differences.h"
#include "tests/model/p1_support.h"

namespace rhexis::test {
namespace {

class P1Derivatives : public testing::TestWithParam<P1Case> {
 protected:
  [[nodiscard]] bool warped() const { return GetParam().name == "warped"; }
  [[nodiscard]] bool mixed() const { return GetParam().settings.kind == model::ModelKind::hyperelastic; }
};

/// A direction in (u, lambda), scaled so that a step of 1 changes stretches and stresses by some tenths.
model::State random_direction(const model::State& at, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  model::State out = at;
  for (double& value : out.u) value = 0.02 * unit(random);
  for (double& value : out.lambda) value = 5e4 * unit(random);
  return out;
}

model::State step(const model::State& at, const model::State& direction, double s) {
  return {at.u + s * direction.u, at.lambda + s * direction.lambda};
}

double dot(const VectorX& residual, const model::State& direction) {
  return residual.head(direction.u.size()).dot(direction.u) +
         residual.tail(direction.lambda.size()).dot(direction.lambda);
}

TEST_P(P1Derivatives, ResidualIsTheGradientOfTheEnergy) {
  const mesh::TetMesh mesh = distorted_box({2, 2, 3});
  const auto model = model::make_model(mesh, GetParam().settings);
  for (const unsigned seed : {1U, 2U, 3U}) {
    const model::State state = random_state(mesh, model->pressure_unknowns(), seed);
    const model::State direction = random_direction(state, seed + 100);
    const Evaluated at = evaluate(*model, state);
    const double expected = dot(at.residual, direction);
    ASSERT_GT(std::abs(expected), 1e-3 * std::abs(at.energy));  // not trivially zero
    const double measured = scalar_derivative([&](double s) { return model->energy(step(state, direction, s)); }, 5e-3);
    // Order 6 at a fifth of a percent of the scale: truncation and rounding both near 1e-12 of the energy per step.
    EXPECT_NEAR(measured, expected, 1e-9 * (std::abs(expected) + std::abs(at.energy)));
  }
}

TEST_P(P1Derivatives, TetsAddUpToTheEnergyAndTheForces) {
  const mesh::TetMesh mesh = distorted_box({2, 2, 3});
  const auto model = model::make_model(mesh, GetParam().settings);
  const model::State state = random_state(mesh, model->pressure_unknowns());
  double energy = 0.0;
  VectorX force = VectorX::Zero(state.u.size());
  for (std::size_t t = 0; t < mesh.tet_count(); ++t) {
    const element::LinearTet shape = element::make_linear_tet(mesh::corners(mesh, TetId(t)));
    Mat3 F = Mat3::Identity();
    for (std::size_t a = 0; a < 4; ++a)
      F += state.u.segment<3>(3 * Eigen::Index{mesh.tets[t][a].value()}) * shape.gradient[a].transpose();
    const model::TetState tet = model->tet_state(state, TetId(t), F);
    energy += shape.volume * tet.W;
    for (std::size_t a = 0; a < 4; ++a)
      force.segment<3>(3 * Eigen::Index{mesh.tets[t][a].value()}) += shape.volume * tet.P * shape.gradient[a];
  }
  model::ModelSettings without_jumps = GetParam().settings;  // which are of faces
  without_jumps.beta = 0.0;
  const double expected = model::make_model(mesh, without_jumps)->energy(state);
  EXPECT_NEAR(energy, expected, 1e-13 * std::abs(expected));
  const VectorX of_model = evaluate(*model, state).residual.head(state.u.size());
  EXPECT_LT((force - of_model).norm(), 1e-13 * of_model.norm());
}

TEST_P(P1Derivatives, TangentIsTheDerivativeOfTheResidual) {
  const mesh::TetMesh mesh = distorted_box({2, 2, 3});
  const auto model = model::make_model(mesh, GetParam().settings);
  for (const unsigned seed : {1U, 2U, 3U}) {
    const model::State state = random_state(mesh, model->pressure_unknowns(), seed);
    const model::State direction = random_direction(state, seed + 100);
    VectorX along(state.u.size() + state.lambda.size());
    along << direction.u, direction.lambda;
    const VectorX expected = evaluate(*model, state).tangent * along;
    const VectorX measured =
        derivative([&](double s) { return evaluate(*model, step(state, direction, s)).residual; }, 5e-3);
    const Eigen::Index dofs = state.u.size(), pressures = state.lambda.size();
    const double error = (measured - expected).head(dofs).norm() / expected.head(dofs).norm();
    if (warped()) {
      // R K R^T leaves out dR: some percent off, which is why the exact tangent is the default.
      EXPECT_GT(error, 1e-3);
      EXPECT_LT(error, 0.5);
    } else {
      EXPECT_LT(error, 1e-9);
    }
    if (pressures > 0) {
      EXPECT_LT((measured - expected).tail(pressures).norm(), 1e-9 * expected.tail(pressures).norm());
    }
  }
}

TEST_P(P1Derivatives, RigidMotionsLeaveNoForce) {
  const mesh::TetMesh mesh = distorted_box({3, 2, 2});
  const auto model = model::make_model(mesh, GetParam().settings);
  const Mat3 Q = Eigen::AngleAxisd(2.2, Vec3(1.0, 0.5, -2.0).normalized()).toRotationMatrix();
  model::State state = model->initial_state();
  state.lambda.setZero();
  const double stiffness = evaluate(*model, state).tangent.topLeftCorner(state.u.size(), state.u.size()).norm();
  for (std::size_t n = 0; n < mesh.node_count(); ++n) {
    const Vec3 x = mesh.nodes[n];
    // The linear model knows infinitesimal rotations alone.
    const Vec3 u = model->is_linear() ? Vec3(0.3 * Vec3(0.2, 1.0, -0.4).cross(x)) : Vec3(Q * x - x);
    state.u.segment<3>(static_cast<Eigen::Index>(3 * n)) = u + Vec3(0.1, -0.2, 0.05);
  }
  const Evaluated moved = evaluate(*model, state);
  EXPECT_GT(state.u.norm(), 0.1);
  // Displacements near 0.5 m carry 1e-16 of rounding.
  EXPECT_LT(moved.residual.head(state.u.size()).norm(), 1e-14 * stiffness);
  if (mixed()) {
    EXPECT_LT(moved.residual.tail(state.lambda.size()).norm(), 1e-14 * mesh::total_volume(mesh));
  }
  EXPECT_NEAR(moved.energy, 0.0, 1e-14 * stiffness);
  EXPECT_NEAR(moved.of_residual.min_J, 1.0, model->is_linear() ? 0.5 : 1e-12);
}

TEST_P(P1Derivatives, ForcesBalance) {
  const mesh::TetMesh mesh = distorted_box({3, 2, 2});
  const auto model = model::make_model(mesh, GetParam().settings);
  const model::State state = random_state(mesh, model->pressure_unknowns());
  const Evaluated at = evaluate(*model, state);
  Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
  double size = 0.0;
  for (std::size_t n = 0; n < mesh.node_count(); ++n) {
    const Vec3 f = at.residual.segment<3>(static_cast<Eigen::Index>(3 * n));
    force += f;
    moment += (mesh.nodes[n] + state.u.segment<3>(static_cast<Eigen::Index>(3 * n))).cross(f);
    size += f.norm();
  }
  ASSERT_GT(size, 1.0);
  EXPECT_LT(force.norm(), 1e-14 * size);
  if (!model->is_linear()) {
    EXPECT_LT(moment.norm(), 1e-14 * size);
  }
}

/// Under a uniform gradient all inner nodes are in balance, and the stress is the same everywhere.
TEST_P(P1Derivatives, PatchTest) {
  const mesh::TetMesh mesh = distorted_box({4, 4, 4}, 0.1);
  const auto model = model::make_model(mesh, GetParam().settings);
  Mat3 gradient;
  gradient << 0.1, 0.12, -0.05, 0.03, -0.08, 0.07, -0.04, 0.06, 0.05;
  model::State state = model->initial_state();
  for (std::size_t n = 0; n < mesh.node_count(); ++n) {
    state.u.segment<3>(static_cast<Eigen::Index>(3 * n)) = gradient * mesh.nodes[n];
  }
  const double J = (Mat3::Identity() + gradient).determinant();
  if (mixed()) state.lambda.setConstant(kLaw.kappa * (J - 1.0));
  const Evaluated at = evaluate(*model, state);
  std::vector<bool> outer(mesh.node_count(), false);
  for (const char* side : {"-x", "+x", "-y", "+y", "-z", "+z"}) {
    for (const NodeId node : mesh.find_node_set(side)->nodes) outer[node.index()] = true;
  }
  double inside = 0.0, outside = 0.0;
  for (std::size_t n = 0; n < mesh.node_count(); ++n) {
    double& largest = outer[n] ? outside : inside;
    largest = std::max(largest, at.residual.segment<3>(static_cast<Eigen::Index>(3 * n)).norm());
  }
  EXPECT_GT(outside, 1.0);
  EXPECT_LT(inside, 1e-13 * outside);
  if (mixed()) {
    // The jump terms of a face are beta (h_e + h_j) A / V times its V (J - 1) and cancel: a thousand times, at beta =
    // 100.
    const double cancelling = 10.0 * (1.0 + GetParam().settings.beta);
    EXPECT_LT(at.residual.tail(state.lambda.size()).norm(), 1e-15 * cancelling * model->volume_change_norm(state));
  }
  const model::TetFields fields = model->fields(state);
  for (std::size_t t = 0; t < mesh.tet_count(); ++t) {
    EXPECT_NEAR(fields.J[t], J, 1e-13);
    for (std::size_t c = 0; c < 6; ++c) EXPECT_NEAR(fields.stress[6 * t + c], fields.stress[c], 1e-7);  // Pa, of 1e4
  }
}

INSTANTIATE_TEST_SUITE_P(All, P1Derivatives, testing::ValuesIn(p1_cases()),
                         [](const auto& tested) { return tested.param.name; });

}  // namespace
}  // namespace rhexis::test
