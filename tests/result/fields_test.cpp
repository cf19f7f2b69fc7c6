#include "result/fields.h"

#include <gtest/gtest.h>

#include <cmath>

#include "mesh/generate.h"
#include "model/make_model.h"
#include "solver/equilibrium.h"
#include "tests/support/bodies.h"

namespace rhexis {
namespace {

class Fields : public testing::Test {
 protected:
  Fields() {
    model::ModelSettings settings;
    settings.kind = model::ModelKind::linear;
    settings.elastic = {1e5, 0.25};
    body_ = model::make_model(mesh_, settings);
    state_ = body_->initial_state();
    // Simple shear in x-y and a stretch in z: sigma_xy = mu g, the rest from e_zz.
    for (std::size_t n = 0; n < mesh_.node_count(); ++n)
      state_.u.segment<3>(static_cast<Eigen::Index>(3 * n)) =
          Vec3(0.02 * mesh_.nodes[n].y(), 0, 0.01 * mesh_.nodes[n].z());
  }
  const mesh::Field& field(const std::string& name) {
    fields_ = result::make_fields(mesh_, *body_, state_, body_->fields(state_), {});
    return *std::find_if(fields_.begin(), fields_.end(), [&](const mesh::Field& f) { return f.name == name; });
  }

  mesh::TetMesh mesh_ = mesh::make_structured_box(Vec3::Ones(), {2, 2, 2});
  std::unique_ptr<model::Model> body_;
  model::State state_;
  std::vector<mesh::Field> fields_;
};

TEST_F(Fields, StressPrincipalAndVonMisesOfAKnownState) {
  const material::Elastic e{1e5, 0.25};
  const double lam = e.lame_lambda() * 0.01;
  const double zz = lam + 2 * e.lame_mu() * 0.01;
  const double xy = e.lame_mu() * 0.02;
  const mesh::Field stress = field("stress");
  const double expected[6] = {lam, lam, zz, xy, 0, 0};
  for (std::size_t c = 0; c < 6; ++c) EXPECT_NEAR(stress.values[c], expected[c], 1e-9 * zz) << c;
  EXPECT_NEAR(field("principal_max").values[0], std::max(zz, lam + xy), 1e-9 * zz);
  EXPECT_NEAR(field("von_mises").values[0], std::sqrt(std::pow(zz - lam, 2) + 3 * xy * xy), 1e-9 * zz);
  const double mean = (2 * lam + zz) / 3;
  EXPECT_NEAR(field("lambda").values[0], mean, 1e-9 * zz);
  EXPECT_EQ(field("pressure").values[0], -field("lambda").values[0]);
}

TEST_F(Fields, MeasuresOfAKnownState) {
  const result::Measures measures = result::measure(mesh_, state_, body_->fields(state_));
  EXPECT_NEAR(measures.volume_ratio, 1.01, 1e-12);  // shear keeps the volume
  EXPECT_EQ(measures.inverted_tets, 0);
  EXPECT_NEAR(measures.pressure_jump, 0.0, 1e-9);  // lambda is the same everywhere
  EXPECT_NEAR(measures.max_displacement, std::hypot(0.02, 0.01), 1e-12);
}

TEST_F(Fields, PressureJumpOfAnOscillatingState) {
  model::ModelSettings settings;
  settings.kind = model::ModelKind::hyperelastic;
  settings.law = {1e4, 1e4, 1e6};
  const auto psh = model::make_model(mesh_, settings);
  model::State state = psh->initial_state();
  // +-1 by the parity of the tet: mean |lambda| is 1, and a face jumps by 0 or 2.
  for (Eigen::Index t = 0; t < state.lambda.size(); ++t) state.lambda[t] = t % 5 == 4 ? -1.0 : 1.0;
  // In a cell of five tets the middle one (the last) meets the other four; faces between cells join equals.
  const double cell_faces = 4 * std::sqrt(3.0) / 2 * 0.25;  // equilateral, side sqrt(2)/2
  const double between = 3 * 2 * 2 * (2 - 1) * 0.25;
  const double expected = std::sqrt(4.0 * 8 * cell_faces / (8 * cell_faces + between));
  EXPECT_NEAR(result::measure(mesh_, state, psh->fields(state)).pressure_jump, expected, 1e-12);
}

TEST(Reactions, BalanceTheLoadInForceAndMomentInTheFilesOfEveryModel) {
  const mesh::TetMesh mesh = mesh::make_structured_box(Vec3(0.1, 0.1, 0.2), {2, 2, 4});
  for (int kind = 0; kind < 6; ++kind) {
    model::ModelSettings settings;
    settings.kind = static_cast<model::ModelKind>(kind);
    settings.elastic = {1e5, 0.45};
    settings.law = material::to_mooney_rivlin(settings.elastic);
    settings.beta = 1.0;
    const auto body = model::make_model(mesh, settings);
    model::Loading loading = test::no_load(*body);
    test::clamp(loading, mesh, *body, "-z");
    const Vec3 force(0.02, -0.05, 0.1);
    model::add_traction(mesh, body->space(), mesh.find_face_set("+z")->faces, force, loading.dead_force);
    model::State state = body->initial_state();
    const solver::Report report = solver::solve_equilibrium(*body, loading, {.tolerance = 1e-10, .steps = 1}, state);
    ASSERT_TRUE(report.converged()) << body->name() << ": " << report.why;
    for (const mesh::Field& field : result::make_fields(mesh, *body, state, body->fields(state), report.reaction)) {
      if (field.name != "reaction") continue;
      Vec3 sum = Vec3::Zero();
      for (std::size_t n = 0; n < mesh.node_count(); ++n) sum += Eigen::Map<const Vec3>(field.values.data() + 3 * n);
      EXPECT_LT((sum + force).norm(), 1e-8 * force.norm()) << body->name();
    }
  }
}

}  // namespace
}  // namespace rhexis
