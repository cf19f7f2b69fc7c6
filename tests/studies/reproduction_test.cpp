// docs/reproduction.md says what the studies measured. RHEXIS_UPDATE_DOCS=1 writes it anew.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "base/atomic_file.h"
#include "studies/published.h"
#include "studies/report.h"
#include "studies/reproduction.h"
#include "tests/support/run_command.h"

namespace rhexis::studies {
namespace {

using testing::HasSubstr;

TEST(Reproduction, ThePageIsWhatTheStudiesMeasured) {
  const std::filesystem::path docs = std::filesystem::path(RHEXIS_SOURCE_DIR) / "docs";
  const Expected<std::string> page = reproduction_markdown(docs / "reproduction");
  ASSERT_TRUE(page) << page.error().message();
  if (std::getenv("RHEXIS_UPDATE_DOCS") != nullptr) {
    ASSERT_TRUE(write_atomically(docs / "reproduction.md", *page));
  }
  EXPECT_TRUE(test::slurp(docs / "reproduction.md") == *page)
      << "docs/reproduction.md differs from docs/reproduction/*.json; RHEXIS_UPDATE_DOCS=1 on this test writes it";
}

TEST(Reproduction, TakesAStudyAsItWasWritten) {
  const std::filesystem::path path = test::fresh_folder("reproduction");
  const StudyFolder folder = *StudyFolder::open(path / "timing");
  folder.compare("timing.build.linear", 0.18, "a | b");
  ASSERT_TRUE(write_report(folder, {.study = "timing", .title = "t", .command = "rhexis study timing"}, "none"));
  const Expected<std::string> page = reproduction_markdown(path);
  ASSERT_TRUE(page) << page.error().message();
  EXPECT_THAT(*page, HasSubstr("| build of the tangent, linear | 0.09 | 0.18 | corotated build | 2 | paper, Table 6 | "
                               "a \\| b |\n"));
  EXPECT_THAT(*page, HasSubstr("| build of the tangent, corotated | 1 | not measured |"));
  for (const Published& one : published_numbers()) EXPECT_THAT(*page, HasSubstr(std::string(one.source)));
}

TEST(Reproduction, RefusesWhatIsNoStudy) {
  const std::filesystem::path path = test::fresh_folder("reproduction");
  for (const char* text : {"", "[]", "{\"published\": 3}", "{\"published\": [], \"command\": 1}"}) {
    ASSERT_TRUE(write_atomically(path / "models.json", text));
    const Expected<std::string> page = reproduction_markdown(path);
    ASSERT_FALSE(page) << text;
    EXPECT_THAT(page.error().message(), HasSubstr("models.json"));
  }
}

}  // namespace
}  // namespace rhexis::studies
