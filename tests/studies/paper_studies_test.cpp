// The studies of the paper's tables, small: what they write, and that it is as it has to be.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include <Eigen/Geometry>

#include "base/parallel.h"

#include "studies/beta_sweep.h"
#include "studies/identification.h"
#include "studies/iteration_timing.h"
#include "studies/loaded_body.h"
#include "studies/model_comparison.h"
#include "studies/real_time_steps.h"
#include "studies/strain_path.h"
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

TEST(StrainPath, AStretchedBodyHasTheStrainOfItsStretch) {
  const LoadedBody body = *make_vessel(120);
  VectorX u(static_cast<Eigen::Index>(3 * body.mesh.node_count()));
  const Mat3 turn = Eigen::AngleAxisd(0.7, Vec3(1.0, 2.0, 3.0).normalized()).toRotationMatrix();
  for (std::size_t n = 0; n < body.mesh.node_count(); ++n) {
    const Vec3& x = body.mesh.nodes[n];
    u.segment<3>(static_cast<Eigen::Index>(3 * n)) = turn * Vec3(x.x(), x.y(), 1.25 * x.z()) - x;
  }
  EXPECT_NEAR(strain_of(body.mesh, u), 0.25, 1e-12);  // whatever it is turned by
}

TEST(StrainPath, ALimitIsPassedBetweenTwoStepsInProportion) {
  const std::vector<PathPoint> path{{0.5, 0.1, 2.0}, {1.0, 0.3, 6.0}};
  const std::optional<PathPoint> at = passes(path, 4.0);
  ASSERT_TRUE(at);
  EXPECT_DOUBLE_EQ(at->load, 0.75);
  EXPECT_DOUBLE_EQ(at->strain, 0.2);
  EXPECT_DOUBLE_EQ(passes(path, 1.0)->load, 0.25);  // from nothing
  EXPECT_FALSE(passes(path, 6.0));
}

TEST(ModelComparison, TheModelsPartAsTheirLawsDo) {
  const StudyFolder folder = *StudyFolder::open(test::fresh_folder("models"));
  const Expected<ordered_json> rows =
      run_model_comparison({.nodes = 120, .densities = {500.0}, .shared = "none"}, folder, kGoesOn);
  ASSERT_TRUE(rows) << rows.error().message();
  ASSERT_EQ(rows->size(), 7U);
  std::map<std::string, ordered_json> by_model;
  for (const ordered_json& row : *rows) by_model[row["model"]] = row;
  EXPECT_EQ(by_model["hyperelastic"]["max"], 0.0);
  EXPECT_GT(by_model["linear"]["mean"], by_model["corotated"]["mean"]);
  EXPECT_LT(by_model["hyperelastic, auto"]["mean"], by_model["corotated"]["mean"]);
  for (const auto& [name, row] : by_model) {
    EXPECT_TRUE(row["converged"]) << name;
    EXPECT_GE(row["max"], row["mean"]);
  }
  EXPECT_EQ(folder.contents().published.size(),
            16U);  // three models by five measures, volume; one density has no trend
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "models-departure.csv"));
}

TEST(RealTimeSteps, AHandThatHardlyMovesStaysAtEquilibrium) {
  const LoadedBody body = *make_vessel(120, 0.1, 0.1);
  const RealTimeSteps run =
      step_in_real_time(body, paper_material(model::ModelKind::corotated), "direct", 0.004 / 1.0);  // m/s
  EXPECT_TRUE(run.held);
  EXPECT_GT(run.steps, 10);
  EXPECT_LT(run.largest_mm, 0.02);  // of a way of 4 mm
}

TEST(Timing, TimesEveryModelAndSaysWhatIsLeftOut) {
  const StudyFolder folder = *StudyFolder::open(test::fresh_folder("timing"));
  const int threads = thread_count();
  const Expected<ordered_json> rows = run_timing({.nodes = {120}, .threads = {1}}, folder, kGoesOn);
  ASSERT_TRUE(rows) << rows.error().message();
  EXPECT_EQ(thread_count(), threads);
  ASSERT_EQ(rows->size(), 18U);
  for (const ordered_json& row : *rows) {
    if (row["outcome"] != "converged") {
      EXPECT_TRUE(row["iteration_ms"].is_null());
      continue;
    }
    EXPECT_GT(row["solve_ms"], 0.0);
    if (row["model"] == "corotated" && row["linear"] == "direct") {
      EXPECT_EQ(row["tangent_ratio"], 1.0);
      EXPECT_EQ(row["iteration_ratio"], 1.0);
    }
  }
  EXPECT_EQ(folder.contents().published.size(), 10U);
  EXPECT_FALSE(run_timing({.solvers = {"qr"}}, folder, kGoesOn));
  EXPECT_FALSE(run_timing({.threads = {0}}, folder, kGoesOn));
}

}  // namespace
}  // namespace rhexis::studies
