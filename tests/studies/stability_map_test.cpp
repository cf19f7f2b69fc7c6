#include "studies/stability_map.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/support/run_command.h"

namespace rhexis::studies {
namespace {

using nlohmann::ordered_json;
using testing::HasSubstr;

bool go_on(double, std::string_view) { return true; }

StabilityOptions small() {
  StabilityOptions options;
  options.stiffness = {500.0, 8000.0};
  options.delay = {0, 6};
  options.seconds = 2.0;
  return options;
}

TEST(StabilityMap, HasARowForEachStiffnessAndDelay) {
  const std::filesystem::path folder = test::fresh_folder("stability");
  const Expected<ordered_json> rows = run_stability_map(small(), *StudyFolder::open(folder), go_on);
  ASSERT_TRUE(rows) << rows.error().message();
  ASSERT_EQ(rows->size(), 4U);
  EXPECT_TRUE((*rows)[0]["rests_free"]) << "soft and prompt";
  EXPECT_FALSE((*rows)[3]["rests_free"]) << "stiff and late";
  for (const ordered_json& row : *rows) {
    EXPECT_GT(row["bound"].get<double>(), 0.0);
    EXPECT_NEAR(row["over_bound"].get<double>() * row["bound"].get<double>(), row["stiffness"].get<double>(), 1e-9);
    EXPECT_LE(row["force_N_kept"].get<double>(), 8.9 * (1.0 + 1e-12));
  }
  for (const char* name : {"haptic-stability.csv", "haptic-stability.json", "haptic-stability.svg"})
    EXPECT_TRUE(std::filesystem::exists(folder / name)) << name;
}

TEST(StabilityMap, StopsWhenAskedToAndRefusesWhatCannotBe) {
  const StudyFolder folder = *StudyFolder::open(test::fresh_folder("stability"));
  const Expected<ordered_json> one = run_stability_map(small(), folder, [](double, std::string_view) { return false; });
  ASSERT_TRUE(one);
  EXPECT_EQ(one->size(), 1U);
  StabilityOptions options = small();
  options.delay = {1000};
  EXPECT_THAT(run_stability_map(options, folder, go_on).error().message(), HasSubstr("delay of 1000"));
  options = small();
  options.stiffness = {-1.0};
  EXPECT_THAT(run_stability_map(options, folder, go_on).error().message(), HasSubstr("-1"));
  options.stiffness.clear();
  EXPECT_FALSE(run_stability_map(options, folder, go_on));
}

}  // namespace
}  // namespace rhexis::studies
