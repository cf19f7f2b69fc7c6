#include "studies/study_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/atomic_file.h"
#include "tests/support/run_command.h"

namespace rhexis::studies {
namespace {

using nlohmann::ordered_json;

TEST(StudyFolder, ATableIsTheSameInBothFormats) {
  const std::filesystem::path folder = test::fresh_folder("study-folder");
  const ordered_json rows{{{"name", "a, \"b\""}, {"count", 3}, {"value", 0.1}, {"none", nullptr}},
                          {{"name", "c"}, {"count", 4}, {"value", std::nan("")}, {"none", 1e300}}};
  ASSERT_TRUE(StudyFolder::open(folder / "deep")->write_table("table", rows));
  EXPECT_EQ(test::slurp(folder / "deep" / "table.csv"),
            "name,count,value,none\n\"a, \"\"b\"\"\",3,0.1,\nc,4,,1e+300\n");
  const ordered_json read = ordered_json::parse(test::slurp(folder / "deep" / "table.json"));
  ASSERT_EQ(read.size(), 2U);
  EXPECT_EQ(read[0], rows[0]);
  EXPECT_TRUE(read[1]["value"].is_null());
}

TEST(StudyFolder, AFolderThatCannotBeMadeIsAnError) {
  const std::filesystem::path folder = test::fresh_folder("study-folder");
  ASSERT_TRUE(write_atomically(folder / "file", "in the way"));
  const Expected<StudyFolder> study = StudyFolder::open(folder / "file" / "deep");
  ASSERT_FALSE(study);
  EXPECT_THAT(study.error().message(), testing::HasSubstr("cannot make the folder"));
}

TEST(StudyFolder, AFigureHasItsName) {
  const std::filesystem::path folder = test::fresh_folder("study-folder");
  const StudyFolder study = *StudyFolder::open(folder);
  EXPECT_FALSE(study.write_figure("figure", {.title = "empty"}));
  EXPECT_TRUE(study.write_figure("figure", {.title = "one", .series = {{.name = "a", .x = {1.0}, .y = {2.0}}}}));
  EXPECT_EQ(test::slurp(folder / "figure.svg").substr(0, 4), "<svg");
}

}  // namespace
}  // namespace rhexis::studies
