#include "studies/live_models.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/run_command.h"

namespace rhexis::studies {
namespace {

using nlohmann::ordered_json;
using testing::HasSubstr;

LiveModelsOptions small() {
  LiveModelsOptions options;
  options.nodes = {100};
  options.speeds = {0.02};
  options.seconds = 0.3;
  options.samples = 2;
  options.frame = 1.0 / 60.0;  // whatever the machine is busy with
  return options;
}

TEST(LiveModels, EveryModelHasARowAndAForceNearTheConvergedOne) {
  const std::filesystem::path folder = test::fresh_folder("live_models");
  const Expected<ordered_json> rows =
      run_live_models(small(), *StudyFolder::open(folder), [](double, std::string_view) { return true; });
  ASSERT_TRUE(rows) << rows.error().message();
  ASSERT_EQ(rows->size(), 3U);
  for (const ordered_json& row : *rows) {
    SCOPED_TRACE(row.dump());
    EXPECT_EQ(row["oracle_failed"], 0);
    EXPECT_GT(row["force_N"].get<double>(), 0.0);
    EXPECT_LT(row["error_most"].get<double>(), 0.02);
    EXPECT_LE(row["frame_ms"], row["frame_ms_most"]);
  }
  for (const char* file : {"live-models.csv", "live-models.json", "live-models.svg"})
    EXPECT_TRUE(exists(folder / file));
}

TEST(LiveModels, WhatCannotBeIsRefused) {
  const StudyFolder folder = *StudyFolder::open(test::fresh_folder("live_models_refused"));
  const auto error = [&](const auto& change) {
    LiveModelsOptions options = small();
    change(options);
    const Expected<ordered_json> rows = run_live_models(options, folder, [](double, std::string_view) { return true; });
    return rows ? std::string("accepted") : rows.error().message();
  };
  EXPECT_THAT(error([](auto& o) { o.models = {"corotate"}; }), HasSubstr("corotated"));
  EXPECT_THAT(error([](auto& o) { o.models = {"taylor-hood"}; }), HasSubstr("one of"));
  EXPECT_THAT(error([](auto& o) { o.speeds = {0.0}; }), HasSubstr("more than 0"));
  EXPECT_THAT(error([](auto& o) { o.frame = -1.0; }), HasSubstr("0 or more"));
  EXPECT_THAT(error([](auto& o) { o.seconds = -1.0; }), HasSubstr("more than 0"));
  EXPECT_THAT(error([](auto& o) { o.nodes = {3}; }), HasSubstr("nodes"));
  EXPECT_THAT(error([](auto& o) { o.nodes = {}; }), HasSubstr("nothing"));
}

}  // namespace
}  // namespace rhexis::studies
