// Residuals, tangents and energies of other programs (DOLFINx, numpy) at given states.

#include <gtest/gtest.h>

#include "tests/model/p1_support.h"
#include "tests/support/reference.h"
#include "tests/support/shared_data.h"

namespace rhexis::test {
namespace {

std::filesystem::path folder() { return shared_dir() / "reference" / "1_patch"; }

struct Case {
  std::string mesh, state, matrix;
  model::ModelSettings settings;
};

std::vector<Case> cases() {
  std::vector<Case> out;
  for (const std::string mesh : {"tet1", "cube5", "cube24"}) {
    const auto add = [&](const char* state, const char* matrix, model::ModelKind kind, double beta = 0.0,
                         model::CorotatedTangent tangent = model::CorotatedTangent::exact) {
      model::ModelSettings settings;
      settings.kind = kind;
      settings.elastic = kElastic;
      settings.law = kLaw;
      settings.beta = beta;
      settings.corotated_tangent = tangent;
      out.push_back({mesh, state, matrix, settings});
    };
    add("L", "L", model::ModelKind::linear);
    add("C", "C", model::ModelKind::corotated);
    add("C", "C_warped_RKRt", model::ModelKind::corotated, 0.0, model::CorotatedTangent::warped);
    add("G", "G", model::ModelKind::geometrically_nonlinear);
    add("PSH_beta0", "PSH_beta0", model::ModelKind::hyperelastic, 0.0);
    add("PSH_beta1", "PSH_beta1", model::ModelKind::hyperelastic, 1.0);
    add("PSH_beta100", "PSH_beta100", model::ModelKind::hyperelastic, 100.0);
  }
  return out;
}

class P1Reference : public testing::TestWithParam<Case> {};

TEST_P(P1Reference, EnergyResidualAndTangentAgree) {
  RHEXIS_SKIP_WITHOUT(folder());
  const Case& c = GetParam();
  const mesh::TetMesh mesh = read_reference_mesh(folder() / c.mesh);
  const auto model = model::make_model(mesh, c.settings);
  const nlohmann::json dump = read_json(folder() / (c.mesh + "_dump.json"));

  model::State state = model->initial_state();
  for (std::size_t n = 0; n < mesh.node_count(); ++n) {
    for (std::size_t i = 0; i < 3; ++i) state.u[static_cast<Eigen::Index>(3 * n + i)] = dump["u"][n][i];
  }
  for (Eigen::Index t = 0; t < state.lambda.size(); ++t) {
    state.lambda[t] = dump["lambda"][static_cast<std::size_t>(t)];
  }
  const Evaluated ours = evaluate(*model, state);

  const nlohmann::json& theirs = dump["states"].contains(c.state) ? dump["states"][c.state] : dump[c.state];
  // Their u is printed with six decimals and read back exactly; sums of some ten terms differ in their order.
  EXPECT_NEAR(ours.energy, theirs["energy"].get<double>(), 1e-12 * std::abs(theirs["energy"].get<double>()));
  VectorX residual(ours.residual.size());
  for (std::size_t n = 0; n < mesh.node_count(); ++n) {
    for (std::size_t i = 0; i < 3; ++i) residual[static_cast<Eigen::Index>(3 * n + i)] = theirs["R_u"][n][i];
  }
  const Eigen::Index dofs = state.u.size(), pressures = state.lambda.size();
  EXPECT_LT((ours.residual.head(dofs) - residual.head(dofs)).norm(), 1e-12 * residual.head(dofs).norm());
  if (pressures > 0) {
    for (Eigen::Index t = 0; t < pressures; ++t) residual[dofs + t] = theirs["R_lambda"][static_cast<std::size_t>(t)];
    EXPECT_LT((ours.residual.tail(pressures) - residual.tail(pressures)).norm(),
              1e-12 * residual.tail(pressures).norm());
  }

  const std::vector<double> entries = read_csv(folder() / (c.mesh + "_K_" + c.matrix + ".csv"));
  ASSERT_EQ(static_cast<Eigen::Index>(entries.size()), ours.tangent.size());
  const Eigen::MatrixXd K =
      Eigen::Map<const Eigen::MatrixXd>(entries.data(), ours.tangent.rows(), ours.tangent.cols());  // symmetric
  // Block by block: the pressure blocks are many orders smaller than A.
  const auto expect_close = [&](Eigen::Index r, Eigen::Index q, Eigen::Index rn, Eigen::Index qn) {
    const double scale = K.block(r, q, rn, qn).norm();
    EXPECT_LT((ours.tangent.block(r, q, rn, qn) - K.block(r, q, rn, qn)).norm(), 1e-12 * scale) << r << ' ' << q;
  };
  expect_close(0, 0, dofs, dofs);
  if (pressures > 0) {
    expect_close(dofs, 0, pressures, dofs);
    expect_close(dofs, dofs, pressures, pressures);
  }
}

INSTANTIATE_TEST_SUITE_P(All, P1Reference, testing::ValuesIn(cases()),
                         [](const auto& tested) { return tested.param.mesh + "_" + tested.param.matrix; });

}  // namespace
}  // namespace rhexis::test
