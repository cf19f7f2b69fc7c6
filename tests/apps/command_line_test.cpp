// The other commands, and the command line itself.

#include <algorithm>

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
    testing::Values(
        Misuse{"NoCommand", "", "`rhexis` needs a command: solve, tear, precompute, play"},
        Misuse{"UnknownCommand", "slove x.toml", "unknown command 'slove' (did you mean 'solve'?)"},
        Misuse{"UnknownMeshCommand", "mesh mak cube", "unknown command 'mak' (did you mean 'make'?)"},
        Misuse{"UnknownShape", "mesh make sphere x.msh", "unknown command 'sphere' (see `rhexis mesh make --help`)"},
        Misuse{"CommandOfAnotherLevel", "mesh precompute", "unknown command 'precompute'"},
        Misuse{"UnknownOptionAlone", "-x", "unknown option '-x' (see `rhexis --help`)"},
        Misuse{"OptionBeforeCommand", "--jsn solve scenes/bar.toml", "(did you mean '--json'?)"},
        Misuse{"OptionWithATypo", "solve scenes/bar.toml --ot x", "unknown option '--ot' (did you mean '--out'?)"},
        Misuse{"OptionOfACommandAbove", "mesh make cube --quite", "(did you mean '--quiet'?)"},
        Misuse{"OptionWithEquals", "solve scenes/bar.toml --uot=x", "unknown option '--uot' (did you mean"},
        Misuse{"OptionWithOneDash", "solve scenes/bar.toml -out x", "unknown option '-out' (did you mean"},
        Misuse{"NoScene", "solve", "scene is required (see `rhexis solve --help`)"},
        Misuse{"NoSuchScene", "solve none.toml", "none.toml"},
        Misuse{"UnknownOption", "solve scenes/bar.toml --frobnicate",
               "unknown option '--frobnicate' (see `rhexis solve --help`)"},
        Misuse{"SetWithoutValue", "check scenes/bar.toml --set model.beta", "model.beta"},
        Misuse{"SetOfAnUnknownKey", "check scenes/bar.toml --set model.bata=1", "beta"},
        Misuse{"UnsetOfAnUnknownKey", "check scenes/bar.toml --set model.bata=", "(did you mean 'beta'?)"},
        Misuse{"CompareOne", "compare out", "other is required"},
        Misuse{"CompareNothing", "compare none1 none2", "none1"},
        Misuse{"MeshAlone", "mesh", "`rhexis mesh` needs a command: info, convert, make"},
        Misuse{"MeshOfNoFormat", "mesh info README.md", ".msh"},
        Misuse{"ConvertToNoFormat", "mesh convert none.msh none.obj", "none.msh"},
        Misuse{"MakeNoNodes", "mesh make plate p.msh --size 1 1 0.1 --nodes 0", "nodes"},
        Misuse{"MakeFlatPlate", "mesh make plate p.msh --size 1 1 0 --nodes 100", "size"},
        Misuse{"TubeWithoutRadius", "mesh make tube x.msh --length 0.04 --nodes 400", "--radius is required"},
        Misuse{"TubeWithoutLength", "mesh make tube x.msh --radius 0.005 --nodes 400", "--length is required"},
        Misuse{"NegativeNumberIsAValue", "mesh make tube x.msh --nodes 400 --radius -0.005 --length 0.04", "radius"},
        Misuse{"StudyWithoutName", "study", "`rhexis study` needs a command: identification"},
        Misuse{"StudyWithATypo", "study restructering",
               "unknown command 'restructering' (did you mean 'restructuring'?)"},
        Misuse{"NoSuchStudy", "study everything", "unknown command 'everything' (see `rhexis study --help`)"},
        Misuse{"StudyOfNoMode", "study restructuring --mode slow-pul",
               "unknown mode 'slow-pul' (did you mean 'slow-pull'?)"},
        Misuse{"StudyOfNoWay", "study restructuring --way sparce", "unknown way 'sparce' (did you mean 'sparse'?)"},
        Misuse{"StudyOfNoPlate", "study restructuring --nodes 506 3", "'mesh.nodes' is 3 (give an integer, 4 to"},
        Misuse{"StudyOfNoNumber", "study restructuring --nodes many", "--nodes"},
        Misuse{"StudyOfNegativeTime", "study restructuring --seconds -1", "--seconds"},
        Misuse{"StudyIntoAFile", "study restructuring --out README.md/x", "README.md/x: cannot make the folder"},
        Misuse{"ReferenceWithATypo", "scene-reference --shema", "unknown option '--shema' (did you mean '--schema'?)"},
        Misuse{"ReferenceOfSomething", "scene-reference model", "not expected: model (see `rhexis scene-reference"},
        Misuse{"UnknownUnit", "mesh info none.msh --unit furlong",
               "--unit: 'furlong' is no length unit (one of m, dm, cm, mm, um, in) (see `rhexis mesh info "
               "--help`)"}),
    [](const auto& tested) { return tested.param.name; });

TEST(CommandLineHelp, EveryCommandHasAnExample) {
  for (const char* command :
       {"", "solve", "check", "compare", "mesh", "mesh info", "mesh convert", "mesh make", "mesh make plate",
        "mesh make bar", "mesh make cube", "mesh make tube", "study", "study restructuring", "scene-reference"}) {
    const test::Ran ran = test::run_rhexis(std::string(command) + " --help");
    EXPECT_EQ(ran.code, 0) << command;
    EXPECT_THAT(ran.out, HasSubstr("Example: rhexis ")) << command;
    for (const char* common : {"--json", "--quiet", "--verbose"}) EXPECT_THAT(ran.out, HasSubstr(common)) << command;
  }
}

TEST(CommandLineHelp, SaysWhatCanBeWritten) {
  EXPECT_THAT(test::run_rhexis("compare --help").out, HasSubstr("reference other..."));
  EXPECT_THAT(test::run_rhexis("solve --help").out, HasSubstr("KEY= takes the key out"));
  const std::string units = test::run_rhexis("mesh info --help").out;
  EXPECT_THAT(units, HasSubstr("m, dm, cm, mm, um, in"));
  EXPECT_THAT(units, testing::Not(HasSubstr("->")));
}

// A value may look like an option, a command or a wrong word.
TEST(CommandLine, ValuesAreNotTakenForOptions) {
  const fs::path folder = test::fresh_folder("values");
  const test::Ran ran = test::run_rhexis("mesh make tube '" + (folder / "solve.msh").string() +
                                         "' --radius 0.005 --length 0.04 --nodes 400 --bend -90 -q");
  EXPECT_EQ(ran.code, 0) << ran.err;
  EXPECT_EQ(test::run_rhexis("solve --out --ot scenes/none.toml").err.find("unknown"), std::string::npos);
}

TEST(CommandLine, HelpWinsOverWhatFollows) {
  EXPECT_EQ(test::run_rhexis("--help slove").code, 0);
  EXPECT_EQ(test::run_rhexis("--version").code, 0);
}

TEST(SceneReferenceCommand, PrintsWhatTheOptionsOfEveryCommandSay) {
  EXPECT_THAT(test::run_rhexis("scene-reference").out, testing::StartsWith("# Scenes"));
  const std::string schema = test::run_rhexis("scene-reference --schema").out;
  EXPECT_TRUE(json::parse(schema)["properties"].contains("mesh"));
  EXPECT_EQ(test::run_rhexis("scene-reference --json").out, schema);
  EXPECT_EQ(test::run_rhexis("--json scene-reference --quiet").out, schema);
  for (const char* quiet : {"scene-reference -q", "scene-reference --schema --quiet"}) {
    const test::Ran ran = test::run_rhexis(quiet);
    EXPECT_EQ(ran.code, 0);
    EXPECT_EQ(ran.out + ran.err, "") << quiet;
  }
}

TEST(MeshCommand, ReadsInTheUnitGiven) {
  const std::string cube = (test::fresh_folder("unit") / "cube.msh").string();
  ASSERT_EQ(test::run_rhexis("mesh make cube '" + cube + "' --size 2 --nodes 100").code, 0);
  const json info = json::parse(test::run_rhexis("mesh info --json --unit mm '" + cube + "'").out);
  EXPECT_NEAR(info["volume"].get<double>(), 8e-9, 1e-20);
  EXPECT_NEAR(json::parse(test::run_rhexis("mesh info --json '" + cube + "'").out)["volume"].get<double>(), 8, 1e-11);
}

TEST(MeshCommand, QuietIsSilent) {
  const std::string cube = (test::fresh_folder("quiet") / "cube.msh").string();
  for (const std::string& line : {"mesh make cube -q '" + cube + "' --size 1 --nodes 100",
                                  "mesh convert -q '" + cube + "' '" + cube + ".vtu'", "mesh info -q '" + cube + "'"}) {
    const test::Ran ran = test::run_rhexis(line);
    EXPECT_EQ(ran.code, 0) << line;
    EXPECT_EQ(ran.out + ran.err, "") << line;
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

TEST(PlayCommand, ADeviceThatIsNotThereEndsItWithTheNearestName) {
  const auto said = [](const std::string& device) {
    const test::Ran ran = test::run_rhexis("play scenes/plate-tear.toml --device " + device);
    EXPECT_EQ(ran.code, 2);
    EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'), 1);
    return ran.err;
  };
  EXPECT_THAT(said("emulater"), HasSubstr("unknown device 'emulater' (did you mean 'emulator'?)"));
  EXPECT_THAT(said("hammer"), HasSubstr("one of pointer, script, emulator"));
  EXPECT_THAT(said("emulator --force-scale 0"), HasSubstr("more than 0"));
  EXPECT_THAT(said("pointer --token 'a&b'"), HasSubstr("--token: the token has characters"));
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
  EXPECT_EQ(test::run_rhexis("compare -q '" + a.string() + "' '" + b.string() + "'").out, "");
  EXPECT_THAT(test::run_rhexis("compare '" + a.string() + "' '" + b.string() + "'").out, HasSubstr("displacement"));
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
