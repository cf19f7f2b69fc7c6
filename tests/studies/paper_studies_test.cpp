// The studies of the paper's tables, small: what they write, and that it is as it has to be.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "studies/beta_sweep.h"
#include "studies/identification.h"
#include "studies/loaded_body.h"
#include "tests/support/run_command.h"
#include "tests/support/shared_data.h"

namespace rhexis::studies {
namespace {

using nlohmann::ordered_json;

const Progress kGoesOn = [](double, std::string_view) { return true; };

TEST(LoadedBody, TheRefinementIsTheSameBodyHeldInTheSamePlaces) {
  const LoadedBody body = *make_vessel(120);
  const LoadedBody fine = refined(body);
  EXPECT_EQ(fine.mesh.tet_count(), 8 * body.mesh.tet_count());
  EXPECT_NEAR(mesh::total_volume(fine.mesh), mesh::total_volume(body.mesh), 1e-12 * mesh::total_volume(body.mesh));
  // Quadratic displacements on the coarse mesh are held at the same places as linear ones on the fine one.
  const model::Loading quadratic = loading_of(body, model::make_p2_space(body.mesh), 500.0);
  const model::Loading linear = loading_of(fine, model::make_p1_space(fine.mesh), 500.0);
  ASSERT_EQ(quadratic.supports.size(), linear.supports.size());
  for (std::size_t k = 0; k < linear.supports.size(); ++k) {
    EXPECT_EQ(quadratic.supports[k].dof, linear.supports[k].dof);
    EXPECT_EQ(quadratic.supports[k].value, linear.supports[k].value);
  }
  EXPECT_NEAR(linear.dead_force.sum(), -500.0 * kGravity * mesh::total_volume(body.mesh), 1e-9);
}

TEST(Identification, IsFarFromTheTrustedAnswerByLockingAlone) {
  const StudyFolder folder = *StudyFolder::open(test::fresh_folder("identification"));
  const Expected<ordered_json> rows = run_identification({.nodes = 120, .shared = "none"}, folder, kGoesOn);
  ASSERT_TRUE(rows) << rows.error().message();
  ASSERT_EQ(rows->size(), 4U);  // two densities, two meshes
  for (const ordered_json& row : *rows) {
    EXPECT_GT(row["mean_percent"], 1.0);
    EXPECT_LT(row["mean_percent"], 30.0);
  }
  EXPECT_EQ(folder.contents().published.size(), 4U);
  for (const ordered_json& row : folder.contents().published)
    if (row["id"] == "identification.mean.rho510") {
      EXPECT_TRUE(row["ours"].is_null());
    }
}

TEST(Identification, IsWhatOtherProgramsCompute) {
  RHEXIS_SKIP_WITHOUT(test::shared_dir() / "reference" / "4_vessel_small" / "mesh_nodes.csv");
  const StudyFolder folder = *StudyFolder::open(test::fresh_folder("identification"));
  const Expected<ordered_json> rows = run_identification({.nodes = 120, .shared = test::shared_dir()}, folder, kGoesOn);
  ASSERT_TRUE(rows) << rows.error().message();
  int others = 0;
  for (const ordered_json& row : *rows) {
    if (row["body"] != "reference vessel") continue;
    ++others;
    // Both have residuals of 1e-11 of the force; the files hold 17 digits.
    EXPECT_LT(row["box_percent_max"], 1e-7) << row.dump();
  }
  EXPECT_EQ(others, 3);
}

TEST(BetaSweep, OscillationFallsAsBetaGrowsAndAutoIsNearTheBest) {
  const StudyFolder folder = *StudyFolder::open(test::fresh_folder("stabilisation"));
  const Expected<ordered_json> rows = run_beta_sweep({.nodes = 200}, folder, kGoesOn);
  ASSERT_TRUE(rows) << rows.error().message();
  ASSERT_EQ(rows->size(), 6U);
  double jump = 1e9;
  double best = 1e9;
  double of_auto = 0.0;
  for (const ordered_json& row : *rows) {
    EXPECT_TRUE(row["converged"]);
    EXPECT_LT(row["pressure_jump"], jump);
    jump = row["pressure_jump"];
    best = std::min(best, row["error_lambda_percent"].get<double>());
    if (row["choice"] == "auto") of_auto = row["error_lambda_percent"];
  }
  EXPECT_LT(of_auto, 1.5 * best);  // as docs/stabilisation.md demands of the rule
  EXPECT_LT(5.0 * of_auto, rows->at(0)["error_lambda_percent"].get<double>());
  for (const char* name : {"stabilisation-errors.svg", "stabilisation-errors-formula.svg", "stabilisation-lambda-0.svg",
                           "stabilisation-lambda-auto.svg", "stabilisation-shapes.svg"})
    EXPECT_TRUE(std::filesystem::exists(folder.path() / name)) << name;
}

TEST(BetaSweep, StoppedBeforeTheFirstRowItSaysSo) {
  const StudyFolder folder = *StudyFolder::open(test::fresh_folder("stabilisation"));
  const Expected<ordered_json> rows =
      run_beta_sweep({.nodes = 120}, folder, [](double, std::string_view) { return false; });
  EXPECT_FALSE(rows);
}

}  // namespace
}  // namespace rhexis::studies
