// The batched kernels of every instruction set against one tet at a time with Eigen.

#include <gtest/gtest.h>

#include "base/parallel.h"
#include "element/tet_kernels.h"
#include "model/p1_displacement.h"
#include "model/p1_hyperelastic.h"
#include "tests/model/p1_support.h"
#include "tests/support/slow_tets.h"

namespace rhexis::test {
namespace {

std::unique_ptr<model::Model> make_with(const mesh::TetMesh& mesh, const model::ModelSettings& settings,
                                        const element::TetKernels& kernels) {
  switch (settings.kind) {
    case model::ModelKind::linear: return model::make_linear(mesh, settings, kernels);
    case model::ModelKind::corotated: return model::make_corotated(mesh, settings, kernels);
    case model::ModelKind::geometrically_nonlinear: return model::make_geometrically_nonlinear(mesh, settings, kernels);
    default: return model::make_hyperelastic(mesh, settings, kernels);
  }
}

class P1Kernels : public testing::TestWithParam<std::tuple<const char*, P1Case>> {
 protected:
  void SetUp() override {
    kernels_ = element::find_tet_kernels(std::get<0>(GetParam()));
    if (kernels_ == nullptr) GTEST_SKIP() << "not on this processor";
  }
  /// Largest deviation of energy, residual and tangent, relative.
  void expect_equal(const mesh::TetMesh& mesh, const model::State& state, double tolerance) const {
    const model::ModelSettings& settings = std::get<1>(GetParam()).settings;
    const Evaluated fast = evaluate(*make_with(mesh, settings, *kernels_), state);
    const SlowResult slow = slow_evaluate(mesh, settings, state);
    ASSERT_TRUE(fast.of_residual.finite && fast.of_tangent.finite);
    // The laws' energies are differences of invariants near 3: rounding is that of the moduli, not of the energy.
    const double rounding = 1e-15 * 4.0 * (kLaw.c1 + kLaw.c2) * mesh::total_volume(mesh);
    EXPECT_NEAR(fast.energy, slow.energy, tolerance * std::abs(slow.energy) + rounding);
    const Eigen::MatrixXd K = slow.tangent;
    const Eigen::Index dofs = state.u.size(), pressures = state.lambda.size();
    EXPECT_LT((fast.residual - slow.residual).head(dofs).norm(), tolerance * slow.residual.head(dofs).norm());
    EXPECT_LT((fast.tangent - K).topLeftCorner(dofs, dofs).norm(), tolerance * K.topLeftCorner(dofs, dofs).norm());
    if (pressures == 0) return;
    EXPECT_LT((fast.residual - slow.residual).tail(pressures).norm(), tolerance * slow.residual.tail(pressures).norm());
    EXPECT_LT((fast.tangent - K).bottomLeftCorner(pressures, dofs).norm(),
              tolerance * K.bottomLeftCorner(pressures, dofs).norm());
    EXPECT_LT((fast.tangent - K).bottomRightCorner(pressures, pressures).norm(),
              tolerance * K.bottomRightCorner(pressures, pressures).norm());
  }
  [[nodiscard]] std::int32_t pressures(const mesh::TetMesh& mesh) const {
    const bool mixed = std::get<1>(GetParam()).settings.kind == model::ModelKind::hyperelastic;
    return mixed ? static_cast<std::int32_t>(mesh.tet_count()) : 0;
  }

  const element::TetKernels* kernels_ = nullptr;
};

TEST_P(P1Kernels, RandomStates) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    const mesh::TetMesh mesh = distorted_box({3, 2, 2}, 0.15, seed);
    // Rounding: some ten terms a sum, condition of F below 10.
    expect_equal(mesh, random_state(mesh, pressures(mesh), seed), 1e-13);
  }
}

TEST_P(P1Kernels, SmallStatesKeepTheirDigits) {
  // Displacements of 1e-5 of a tet: the strain itself carries five digits less.
  const mesh::TetMesh mesh = distorted_box({2, 2, 2});
  model::State state = random_state(mesh, pressures(mesh));
  for (double& value : state.u) value = 1e-6 * std::sin(1e3 * value);
  state.lambda *= 1e-4;
  expect_equal(mesh, state, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(All, P1Kernels,
                         testing::Combine(testing::Values("portable", "avx2", "avx512"), testing::ValuesIn(p1_cases())),
                         [](const auto& tested) {
                           return std::string(std::get<0>(tested.param)) + "_" + std::get<1>(tested.param).name;
                         });

class P1Threads : public testing::TestWithParam<P1Case> {
 protected:
  void TearDown() override { set_thread_count(0); }
};

TEST_P(P1Threads, SameBitsWhateverTheirNumber) {
  const mesh::TetMesh mesh = distorted_box({9, 7, 8});
  const auto model = model::make_model(mesh, GetParam().settings);
  const model::State state = random_state(mesh, model->pressure_unknowns());
  const auto scratch = model->make_scratch();
  linalg::SaddleMatrix first, K = model->make_tangent();
  model::Residual first_residual, residual;
  double first_energy = 0.0;
  for (const int threads : {1, 2, 3, 4, 2}) {
    set_thread_count(threads);
    model->residual(state, *scratch, residual);
    model->tangent(state, *scratch, K);
    const double energy = model->energy(state);
    if (threads == 1) {
      first = K;
      first_residual = residual;
      first_energy = energy;
      continue;
    }
    EXPECT_EQ(K.A.values, first.A.values) << threads;
    EXPECT_EQ(K.B.values, first.B.values) << threads;
    EXPECT_EQ(K.C.values, first.C.values) << threads;
    EXPECT_EQ(residual.u, first_residual.u) << threads;
    EXPECT_EQ(residual.lambda, first_residual.lambda) << threads;
    EXPECT_EQ(energy, first_energy) << threads;
  }
}

INSTANTIATE_TEST_SUITE_P(All, P1Threads, testing::ValuesIn(p1_cases()),
                         [](const auto& tested) { return tested.param.name; });

}  // namespace
}  // namespace rhexis::test
