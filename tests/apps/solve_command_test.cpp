// rhexis solve and check from outside: exit codes, streams, files.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include <nlohmann/json.hpp>

#include "mesh/io/mesh_file.h"
#include "tests/support/run_command.h"

namespace rhexis {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;

const std::string kScene = "scenes/vessel.toml --set solver.steps=3 --set mesh.nodes=200";

fs::path write_scene(const fs::path& folder, const std::string& text) {
  std::ofstream(folder / "scene.toml") << text;
  return folder / "scene.toml";
}

TEST(SolveCommand, WritesResultStepsAndSummary) {
  const fs::path out = test::fresh_folder("solve");
  const test::Ran ran = test::run_rhexis("solve " + kScene + " --out '" + out.string() + "'");
  ASSERT_EQ(ran.code, 0) << ran.err;
  EXPECT_THAT(ran.out, HasSubstr("converged"));

  const json summary = json::parse(test::slurp(out / "summary.json"));
  EXPECT_TRUE(summary["converged"]);
  EXPECT_EQ(summary["why"], "");
  EXPECT_EQ(summary["iterations"].size(), 3u);
  EXPECT_LE(summary["residual"].get<double>(), 1e-8);
  EXPECT_EQ(summary["negative_pivots"], 0);
  EXPECT_EQ(summary["inverted_tets"], 0);
  EXPECT_GT(summary["max_displacement"].get<double>(), 0.012);  // the bottom alone moves 12 mm
  for (const char* key : {"read", "build", "solve", "total"}) EXPECT_GE(summary["time"][key].get<double>(), 0.0) << key;
  for (const char* key : {"nodes", "tets", "unknowns", "volume_ratio", "pressure_jump", "versions"})
    EXPECT_TRUE(summary.contains(key)) << key;

  const Expected<mesh::MeshFile> result = mesh::read_mesh_file(out / "result.vtkhdf");
  ASSERT_TRUE(result) << result.error().message();
  EXPECT_EQ(result->mesh.node_count(), summary["nodes"].get<std::size_t>());
  EXPECT_EQ(result->mesh.tet_count(), summary["tets"].get<std::size_t>());
  std::vector<std::string> names;
  for (const mesh::Field& field : result->fields) names.push_back(field.name);
  EXPECT_THAT(names, testing::UnorderedElementsAre("displacement", "reaction", "lambda", "pressure", "stress",
                                                   "principal_max", "von_mises", "J"));

  const std::string series = test::slurp(out / "steps.pvd");
  for (const char* file : {"steps/step_0001.vtu", "steps/step_0002.vtu", "steps/step_0003.vtu"}) {
    EXPECT_THAT(series, HasSubstr(file));
    EXPECT_TRUE(fs::exists(out / file)) << file;
  }
  EXPECT_THAT(series, HasSubstr("timestep=\"1\""));
}

TEST(SolveCommand, StepsEndInTheResult) {
  const fs::path out = test::fresh_folder("last-step");
  ASSERT_EQ(test::run_rhexis("solve " + kScene + " --out '" + out.string() + "'").code, 0);
  const test::Ran ran = test::run_rhexis("--json compare '" + (out / "steps/step_0003.vtu").string() + "' '" +
                                         (out / "result.vtkhdf").string() + "'");
  ASSERT_EQ(ran.code, 0) << ran.err;
  const json comparison = json::parse(ran.out)["comparisons"][0];
  for (const json& field : comparison["fields"]) EXPECT_EQ(field["largest"], 0.0) << field["name"];
}

TEST(SolveCommand, TaylorHoodWritesLambdaOnTheNodesToo) {
  const fs::path out = test::fresh_folder("taylor-hood");
  const test::Ran ran = test::run_rhexis(
      "solve " + kScene + " --set model.kind=taylor-hood --set model.beta= --set solver.steps=2 --out '" +
      out.string() + "'");
  ASSERT_EQ(ran.code, 0) << ran.err;
  const Expected<mesh::MeshFile> result = mesh::read_mesh_file(out / "result.vtkhdf");
  ASSERT_TRUE(result) << result.error().message();
  int on_points = 0;
  for (const mesh::Field& field : result->fields)
    if (field.name == "lambda" && field.centering == mesh::Centering::point) ++on_points;
  EXPECT_EQ(on_points, 1);
}

TEST(SolveCommand, JsonIsAllThatStdoutHolds) {
  const fs::path out = test::fresh_folder("json");
  const test::Ran ran = test::run_rhexis("solve " + kScene + " --json --out '" + out.string() + "'");
  ASSERT_EQ(ran.code, 0) << ran.err;
  EXPECT_EQ(json::parse(ran.out), json::parse(test::slurp(out / "summary.json")));
}

TEST(SolveCommand, NotConvergedIsExitCode1WithTheLastConvergedStateAndTheReason) {
  const fs::path out = test::fresh_folder("not-converged");
  // One iteration a step is not enough, however small the step.
  const test::Ran ran =
      test::run_rhexis("solve " + kScene + " --set solver.max_iterations=1 --out '" + out.string() + "'");
  EXPECT_EQ(ran.code, 1) << ran.out;
  EXPECT_THAT(ran.err, HasSubstr("not converged: at load fraction"));
  const json summary = json::parse(test::slurp(out / "summary.json"));
  EXPECT_FALSE(summary["converged"]);
  EXPECT_THAT(summary["why"].get<std::string>(), HasSubstr("at load fraction"));
  EXPECT_LT(summary["load"].get<double>(), 1.0);
  EXPECT_FALSE(summary["cuts"].empty());
  EXPECT_TRUE(fs::exists(out / "result.vtkhdf"));
}

TEST(SolveCommand, ReplacesTheResultsOfAnEarlierRun) {
  const fs::path out = test::fresh_folder("again");
  ASSERT_EQ(test::run_rhexis("solve " + kScene + " --out '" + out.string() + "'").code, 0);
  ASSERT_EQ(test::run_rhexis("solve " + kScene + " --set solver.steps=1 --out '" + out.string() + "'").code, 0);
  EXPECT_FALSE(fs::exists(out / "steps/step_0002.vtu"));
}

TEST(SolveCommand, BadInputIsExitCode2AndLeavesNothing) {
  const fs::path folder = test::fresh_folder("bad");
  const fs::path scene = write_scene(
      folder,
      "title = \"x\"\n[mesh]\ngenerate = \"bar\"\nsize = [1.0, 1.0, 1.0]\nnodes = 100\n[material]\nyuong = 1.0\n");
  const fs::path out = folder / "out";
  const test::Ran ran = test::run_rhexis("solve '" + scene.string() + "' --out '" + out.string() + "'");
  EXPECT_EQ(ran.code, 2);
  EXPECT_EQ(ran.out, "");
  EXPECT_THAT(ran.err, HasSubstr("scene.toml:7: "));
  EXPECT_THAT(ran.err, HasSubstr("young"));
  EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'), 1) << ran.err;
  EXPECT_FALSE(fs::exists(out));
}

TEST(SolveCommand, AFolderThatCannotBeWrittenToIsExitCode2) {
  const fs::path folder = test::fresh_folder("file-in-the-way");
  std::ofstream(folder / "out") << "a file";
  const test::Ran ran = test::run_rhexis("solve " + kScene + " --out '" + (folder / "out").string() + "'");
  EXPECT_EQ(ran.code, 2);
  EXPECT_THAT(ran.err, HasSubstr("cannot make the folder"));
}

TEST(CheckCommand, SaysWhatItWouldDoAndWritesNothing) {
  const test::Ran ran = test::run_rhexis("check " + kScene);
  EXPECT_EQ(ran.code, 0) << ran.err;
  EXPECT_THAT(ran.out, HasSubstr("unknowns"));
  EXPECT_THAT(ran.out, HasSubstr("3 load steps"));
}

class SceneOfTheProject : public testing::TestWithParam<std::string> {};
TEST_P(SceneOfTheProject, Passes) {
  std::string more;
  if (GetParam() == "plate-recorded.toml") {  // as its head says
    const std::string record = (test::fresh_folder("record") / "plate.h5").string();
    more = " --set interaction.record=" + record;
    EXPECT_EQ(test::run_rhexis("precompute scenes/" + GetParam() + " --out " + record).code, 0);
  }
  const test::Ran ran = test::run_rhexis("check 'scenes/" + GetParam() + "'" + more);
  EXPECT_EQ(ran.code, 0) << ran.err;
}

std::vector<std::string> scene_files() {
  std::vector<std::string> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(fs::path(RHEXIS_SOURCE_DIR) / "scenes"))
    if (entry.path().extension() == ".toml") files.push_back(entry.path().filename().string());
  std::sort(files.begin(), files.end());
  return files;
}
INSTANTIATE_TEST_SUITE_P(All, SceneOfTheProject, testing::ValuesIn(scene_files()), [](const auto& tested) {
  std::string name = fs::path(tested.param).stem().string();
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

}  // namespace
}  // namespace rhexis
