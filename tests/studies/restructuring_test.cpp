#include "studies/restructuring.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include <fmt/format.h>

#include "tests/support/run_command.h"

namespace rhexis::studies {
namespace {

using nlohmann::ordered_json;
using testing::HasSubstr;

bool go_on(double, std::string_view) { return true; }

RestructuringOptions tiny() {
  RestructuringOptions options;
  options.nodes = {150, 300};
  options.seconds_per_case = 0.0;  // one round each
  return options;
}

TEST(Restructuring, EveryWayIsMeasuredOnEveryPlateInBothModes) {
  const std::filesystem::path folder = test::fresh_folder("restructuring");
  double last = 0.0;
  const Expected<ordered_json> rows =
      run_restructuring(tiny(), *StudyFolder::open(folder), [&](double fraction, std::string_view what) {
        EXPECT_GE(fraction, last);
        EXPECT_LE(fraction, 1.0);
        EXPECT_FALSE(what.empty());
        last = fraction;
        return true;
      });
  ASSERT_TRUE(rows) << rows.error().message();
  EXPECT_DOUBLE_EQ(last, 1.0);
  ASSERT_EQ(rows->size(), 2 * (kTearModes.size() * kWays.size() - 1));  // a slow pull has no record
  const std::map<std::string, std::vector<std::string>> parts{
      {"dense-inverse", {"assembly_ms", "factor_ms"}},
      {"sparse", {"assembly_ms", "analysis_ms", "factor_ms"}},
      {"local", {"remesh_ms", "local_ms"}},
      {"exact", {"remesh_ms", "local_ms", "update_ms"}},
      {"exact-all-work", {"remesh_ms", "local_ms", "update_ms"}},
      {"recorded", {"remesh_ms", "local_ms", "update_ms"}}};
  for (const ordered_json& row : *rows) {
    SCOPED_TRACE(row.dump());
    for (const char* positive : {"nodes", "ms_per_advance", "ms_per_tet", "advances", "ms_median", "ms_least",
                                 "sparse_over_this", "tets_per_advance", "length_mm", "mesh_nodes", "mesh_tets"})
      EXPECT_GT(row.at(positive).get<double>(), 0.0) << positive;
    EXPECT_LE(row["ms_least"], row["ms_median"]);
    EXPECT_LE(row["ms_median"], row["ms_most"]);
    EXPECT_NEAR(row["ms_per_tet"].get<double>() * row["tets_per_advance"].get<double>(),
                row["ms_per_advance"].get<double>(), 1e-9 * row["ms_per_advance"].get<double>());
    double sum = 0.0;
    for (const std::string& part : parts.at(row["way"])) sum += row.at(part).get<double>();
    // What a whole advance has beside its parts is judging, which is the tick's.
    if (row["way"].get<std::string>().starts_with("exact") || row["way"] == "recorded") {
      EXPECT_GE(row["ms_per_advance"].get<double>(), sum - 0.01);
    } else {
      EXPECT_NEAR(row["ms_per_advance"].get<double>(), sum, 1e-9 * sum);
    }
    if (row["way"] == "sparse") {
      EXPECT_DOUBLE_EQ(row["sparse_over_this"].get<double>(), 1.0);
    }
    if (row["mode"] == "imposed") {
      EXPECT_NEAR(row["length_mm"].get<double>(), 40.3, 1e-9);
    }
  }
}

TEST(Restructuring, WritesTablesAndTheFigure) {
  const std::filesystem::path folder = test::fresh_folder("restructuring");
  RestructuringOptions options = tiny();
  options.nodes = {150};
  options.modes = {"imposed"};
  options.ways = {"sparse", "exact"};
  const Expected<ordered_json> rows = run_restructuring(options, *StudyFolder::open(folder), go_on);
  ASSERT_TRUE(rows) << rows.error().message();
  ASSERT_EQ(rows->size(), 2U);
  EXPECT_EQ((*rows)[0]["way"], "sparse");
  EXPECT_EQ((*rows)[1]["way"], "exact");
  EXPECT_EQ(ordered_json::parse(test::slurp(folder / "restructuring.json")).size(), 2U);
  const std::string csv = test::slurp(folder / "restructuring.csv");
  EXPECT_THAT(csv, testing::StartsWith("nodes,mode,way,ms_per_advance,ms_per_tet,advances,"));
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 3);
  EXPECT_THAT(test::slurp(folder / "restructuring.svg"), HasSubstr("thesis: whole inverse"));
}

TEST(Restructuring, TheFigureHasTheRowsAndTheThesis) {
  const result::Chart none = restructuring_chart(ordered_json::array());
  ASSERT_EQ(none.series.size(), 2U);
  EXPECT_EQ(none.series[0].y, (std::vector<double>{376.9, 1290.9, 2813.1, 5905.7}));
  EXPECT_EQ(none.series[1].y, (std::vector<double>{7.4, 12.6, 27.5, 30.4}));
  const ordered_json row{{"nodes", 506},          {"mode", "slow-pull"}, {"way", "exact"},
                         {"ms_per_advance", 2.0}, {"ms_least", 1.0},     {"ms_most", 3.0}};
  const result::Chart one = restructuring_chart(ordered_json::array({row}));
  ASSERT_EQ(one.series.size(), 3U);
  EXPECT_EQ(one.series[0].x, std::vector<double>{506.0});
  EXPECT_EQ(one.series[0].y, std::vector<double>{2.0});
  EXPECT_EQ(one.series[0].high, std::vector<double>{3.0});
}

TEST(Restructuring, StopsWithWhatThereIs) {
  const std::filesystem::path folder = test::fresh_folder("restructuring");
  int told = 0;
  const Expected<ordered_json> rows =
      run_restructuring(tiny(), *StudyFolder::open(folder), [&](double, std::string_view) { return ++told < 2; });
  ASSERT_TRUE(rows);
  EXPECT_EQ(told, 2);
  EXPECT_LT(rows->size(), 2 * kTearModes.size() * kWays.size());
  EXPECT_TRUE(std::filesystem::exists(folder / "restructuring.json"));
}

TEST(Restructuring, MistakesAreNamedBeforeAnythingRuns) {
  const StudyFolder folder = *StudyFolder::open(test::fresh_folder("restructuring"));
  const auto error_of = [&](const RestructuringOptions& options) {
    const Expected<ordered_json> rows = run_restructuring(options, folder, [](double, std::string_view) {
      ADD_FAILURE() << "it ran";
      return false;
    });
    return rows ? std::string() : rows.error().message();
  };
  RestructuringOptions options = tiny();
  options.modes = {"imposd"};
  EXPECT_EQ(error_of(options), "unknown mode 'imposd' (did you mean 'imposed'?)");
  options = tiny();
  options.ways = {"exact", "magic"};
  EXPECT_EQ(error_of(options),
            "unknown way 'magic' (one of dense-inverse, sparse, local, exact, exact-all-work, recorded)");
  for (const int nodes : {-1, 0, 3, 2000000000}) {
    options = tiny();
    options.nodes.push_back(nodes);
    EXPECT_THAT(error_of(options), HasSubstr(fmt::format("'mesh.nodes' is {} (give an integer, 4 to", nodes)));
  }
}

}  // namespace
}  // namespace rhexis::studies
