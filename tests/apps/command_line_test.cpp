// The other commands, and the command line itself.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/run_command.h"
#include "tests/support/shared_data.h"

namespace rhexis {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;

struct Misuse {
  std::string name;
  std::string arguments;
  std::string says;
};
std::ostream& operator<<(std::ostream& out, const Misuse& misuse) { return out << misuse.name; }

class CommandLine : public testing::TestWithParam<Misuse> {};
TEST_P(CommandLine, MisuseIsOneLineAndExitCode2) {
  const test::Ran ran = test::run_rhexis(GetParam().arguments);
  EXPECT_EQ(ran.code, 2) << ran.out;
  EXPECT_THAT(ran.err, testing::StartsWith("rhexis: "));
  EXPECT_THAT(ran.err, HasSubstr(GetParam().says));
  EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'), 1) << ran.err;
}
INSTANTIATE_TEST_SUITE_P(
    Misuses, CommandLine,
    testing::Values(Misuse{"NoCommand", "", "subcommand"}, Misuse{"UnknownCommand", "slove x.toml", "slove"},
                    Misuse{"NoScene", "solve", "scene is required"},
                    Misuse{"NoSuchScene", "solve none.toml", "none.toml"},
                    Misuse{"UnknownOption", "solve scenes/bar.toml --frobnicate", "frobnicate"},
                    Misuse{"SetWithoutValue", "check scenes/bar.toml --set model.beta", "model.beta"},
                    Misuse{"SetOfAnUnknownKey", "check scenes/bar.toml --set model.bata=1", "beta"},
                    Misuse{"CompareOne", "compare out", "results"},
                    Misuse{"CompareNothing", "compare none1 none2", "none1"}, Misuse{"MeshAlone", "mesh", "subcommand"},
                    Misuse{"MeshOfNoFormat", "mesh info README.md", ".msh"},
                    Misuse{"ConvertToNoFormat", "mesh convert none.msh none.obj", "none.msh"},
                    Misuse{"MakeNoNodes", "mesh make plate p.msh --size 1 1 0.1 --nodes 0", "nodes"},
                    Misuse{"MakeFlatPlate", "mesh make plate p.msh --size 1 1 0 --nodes 100", "size"},
                    Misuse{"UnknownUnit", "mesh info none.msh --unit parsec", "parsec"}),
    [](const auto& tested) { return tested.param.name; });

TEST(CommandLineHelp, EveryCommandHasAnExample) {
  for (const char* command : {"solve", "check", "compare", "mesh info", "mesh convert", "mesh make plate",
                              "mesh make tube", "scene-reference"}) {
    const test::Ran ran = test::run_rhexis(std::string(command) + " --help");
    EXPECT_EQ(ran.code, 0) << command;
    EXPECT_THAT(ran.out, HasSubstr("Example: rhexis ")) << command;
  }
}

TEST(MeshCommand, MakesConvertsAndDescribes) {
  const fs::path folder = test::fresh_folder("mesh");
  const std::string plate = (folder / "plate.msh").string();
  const std::string copy = (folder / "plate.vtu").string();
  ASSERT_EQ(test::run_rhexis("mesh make plate '" + plate + "' --size 0.24 0.24 0.01 --nodes 506").code, 0);
  ASSERT_EQ(test::run_rhexis("mesh convert '" + plate + "' '" + copy + "'").code, 0);
  const json first = json::parse(test::run_rhexis("mesh info --json '" + plate + "'").out);
  const json second = json::parse(test::run_rhexis("mesh info --json '" + copy + "'").out);
  EXPECT_NEAR(first["nodes"].get<double>(), 506, 0.02 * 506);
  EXPECT_NEAR(first["volume"].get<double>(), 0.24 * 0.24 * 0.01, 1e-12);
  EXPECT_TRUE(first["node_sets"].contains("+x"));
  EXPECT_TRUE(first["defects"].empty());
  for (const char* key : {"nodes", "tets", "volume", "box", "dihedral_degrees", "radius_ratio"})
    EXPECT_EQ(first[key], second[key]) << key;
}

TEST(MeshCommand, ListsEveryDefect) {
  const fs::path folder = test::fresh_folder("defects");
  std::ofstream(folder / "bad.msh")
      << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n6\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 1 1 0\n6 5 5 "
         "5\n$EndNodes\n"
         "$Elements\n3\n1 4 2 0 1 1 2 3 4\n2 4 2 0 1 1 2 3 5\n3 4 2 0 1 1 2 3 4\n$EndElements\n";
  const test::Ran ran = test::run_rhexis("mesh info --json '" + (folder / "bad.msh").string() + "'");
  ASSERT_EQ(ran.code, 0) << ran.err;
  const std::string defects = json::parse(ran.out)["defects"].dump();
  EXPECT_THAT(defects, HasSubstr("tet 1 is flat"));
  EXPECT_THAT(defects, HasSubstr("tet 2"));
}

TEST(CompareCommand, AResultEqualsItselfAndDiffersFromAnother) {
  const fs::path a = test::fresh_folder("a");
  const fs::path b = test::fresh_folder("b");
  ASSERT_EQ(test::run_rhexis("solve scenes/bar.toml --set solver.steps=1 --set mesh.nodes=150 --set model.kind=linear "
                             "--set model.beta= --out '" +
                             a.string() + "'")
                .code,
            0);
  ASSERT_EQ(test::run_rhexis("solve scenes/bar.toml --set solver.steps=1 --set mesh.nodes=150 --set model.kind=linear "
                             "--set model.beta= --set gravity=[0,0,-4.905] --set traction.0.force=[0,0,-0.1] --out '" +
                             b.string() + "'")
                .code,
            0);
  const json same =
      json::parse(test::run_rhexis("compare --json '" + a.string() + "' '" + a.string() + "'").out)["comparisons"][0];
  for (const json& field : same["fields"]) EXPECT_EQ(field["largest"], 0.0);
  const json half =
      json::parse(test::run_rhexis("compare --json '" + a.string() + "' '" + b.string() + "'").out)["comparisons"][0];
  for (const json& field : half["fields"])
    if (field["name"] == "displacement") {
      EXPECT_NEAR(field["relative_largest"].get<double>(), 0.5,
                  1e-9);  // linear: half the weight, half the displacement
    }
}

TEST(CompareCommand, RefusesAnotherMesh) {
  const fs::path a = test::fresh_folder("mesh-a");
  const fs::path b = test::fresh_folder("mesh-b");
  const std::string common = "solve scenes/bar.toml --set solver.steps=1 --set model.kind=linear --set model.beta= ";
  ASSERT_EQ(test::run_rhexis(common + "--set mesh.nodes=150 --out '" + a.string() + "'").code, 0);
  ASSERT_EQ(test::run_rhexis(common + "--set mesh.nodes=250 --out '" + b.string() + "'").code, 0);
  const test::Ran ran = test::run_rhexis("compare '" + a.string() + "' '" + b.string() + "'");
  EXPECT_EQ(ran.code, 2);
  EXPECT_THAT(ran.err, HasSubstr("compare results on the same mesh"));
}

}  // namespace
}  // namespace rhexis
