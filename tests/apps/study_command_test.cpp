// rhexis study NAME, as a user types it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include <nlohmann/json.hpp>

#include "tests/support/run_command.h"

namespace rhexis {
namespace {

using nlohmann::json;
using testing::HasSubstr;

TEST(StudyCommand, WritesItsFilesAndPrintsItsRows) {
  const std::filesystem::path folder = test::fresh_folder("study");
  const std::string arguments =
      "study restructuring --nodes 150 --mode slow-pull imposed --way sparse exact --seconds 0 --out '" +
      (folder / "out").string() + "'";
  const test::Ran table = test::run_rhexis(arguments);
  ASSERT_EQ(table.code, 0) << table.err;
  EXPECT_THAT(table.out, HasSubstr("ms_per_advance"));
  EXPECT_THAT(table.out, HasSubstr("slow-pull"));
  EXPECT_THAT(table.out, HasSubstr("report.html"));
  for (const char* name : {"restructuring.csv", "restructuring.json", "restructuring.svg", "study.json", "report.html"})
    EXPECT_TRUE(std::filesystem::exists(folder / "out" / name)) << name;

  const test::Ran as_json = test::run_rhexis("--json " + arguments);
  ASSERT_EQ(as_json.code, 0) << as_json.err;
  const json rows = json::parse(as_json.out);
  ASSERT_EQ(rows.size(), 4U);
  for (const json& row : rows)
    for (const char* key : {"nodes", "mode", "way", "ms_per_advance", "ms_per_tet", "advances"})
      EXPECT_TRUE(row.contains(key)) << key;
  EXPECT_EQ(rows, json::parse(test::slurp(folder / "out" / "restructuring.json")));
  EXPECT_EQ(test::run_rhexis("--quiet " + arguments).out, "");
}

TEST(StudyCommand, MapsWhatAHapticDeviceBears) {
  const std::filesystem::path folder = test::fresh_folder("stability");
  const test::Ran ran = test::run_rhexis("study haptic-stability --stiffness 500 8000 --delay 0 6 --seconds 2 --out '" +
                                         folder.string() + "'");
  ASSERT_EQ(ran.code, 0) << ran.err;
  EXPECT_THAT(ran.out, HasSubstr("rests_kept"));
  EXPECT_THAT(ran.out, HasSubstr("yes"));
  EXPECT_THAT(ran.out, HasSubstr("no"));
  EXPECT_TRUE(std::filesystem::exists(folder / "haptic-stability.svg"));
  EXPECT_EQ(test::run_rhexis("study haptic-stability --delay 100 --out '" + folder.string() + "'").code, 2);
}

TEST(StudyCommand, MeasuresALiveSession) {
  const std::filesystem::path folder = test::fresh_folder("live");
  const std::string out = " --out '" + folder.string() + "'";
  const test::Ran ran = test::run_rhexis("study live --seconds 1 --nodes 200 --clients 1 --device script" + out);
  ASSERT_EQ(ran.code, 0) << ran.err;
  EXPECT_THAT(ran.out, HasSubstr("ticks within 1 ms of their time"));
  EXPECT_TRUE(std::filesystem::exists(folder / "live-ticks.svg"));
  EXPECT_EQ(test::run_rhexis("study live --seconds 1 --nodes 200 --device pointer" + out).code, 2);
  EXPECT_EQ(test::run_rhexis("study live --seconds 1 --nodes 3" + out).code, 2);
}

TEST(StudyCommand, TakesTheAnswersOfAScript) {
  const std::filesystem::path folder = test::fresh_folder("angles");
  const std::string command = "study angle-perception --out '" + (folder / "out").string() + "' --answers '";
  std::ofstream(folder / "answers.txt") << "A\nb\nA\n";
  const test::Ran ran = test::run_rhexis(command + (folder / "answers.txt").string() + "'");
  ASSERT_EQ(ran.code, 0) << ran.err;
  EXPECT_THAT(ran.out, HasSubstr("critical"));
  const std::string kept = test::slurp(folder / "out/trials.jsonl");
  EXPECT_EQ(std::count(kept.begin(), kept.end(), '\n'), 4) << "a line on what they answer, and one each";
  EXPECT_TRUE(std::filesystem::exists(folder / "out/report.html"));
  std::ofstream(folder / "wrong.txt") << "A\n\nC\n";
  const test::Ran wrong = test::run_rhexis(command + (folder / "wrong.txt").string() + "'");
  EXPECT_EQ(wrong.code, 2);
  EXPECT_THAT(wrong.err, HasSubstr("wrong.txt:3: 'C' is no answer (A or B)"));
  EXPECT_EQ(test::run_rhexis("study angle-perception --experiment nowhere.toml").code, 2);
  EXPECT_EQ(test::run_rhexis("study angle-perception --seed -1").code, 2);
  EXPECT_EQ(test::run_rhexis(command + (folder / "answers.txt").string() + "' --with person --no-browser").code, 2);
  EXPECT_EQ(test::run_rhexis("study angle-perception --with people").code, 2);
}

TEST(StudyCommand, TheReportSaysHowItWasMade) {
  const std::filesystem::path folder = test::fresh_folder("made");
  const std::string arguments =
      "study haptic-stability --stiffness 500 --delay 0 --seconds 2 --out '" + folder.string() + "'";
  ASSERT_EQ(test::run_rhexis(arguments).code, 0);
  const json about = json::parse(test::slurp(folder / "study.json"));
  EXPECT_THAT(about["command"].get<std::string>(),
              testing::StartsWith("rhexis study haptic-stability --stiffness 500"));
  EXPECT_EQ(about["tables"], json({"haptic-stability"}));
  EXPECT_THAT(test::slurp(folder / "report.html"), HasSubstr(about["versions"]["compiler"].get<std::string>()));
}

TEST(StudyCommand, HelpNamesTheWays) {
  for (const char* name : {"identification", "stabilisation", "restructuring", "live", "all"})
    EXPECT_THAT(test::run_rhexis("study --help").out, HasSubstr(name));
  EXPECT_THAT(test::run_rhexis("study restructuring --help").out, HasSubstr("exact-all-work"));
}

}  // namespace
}  // namespace rhexis
