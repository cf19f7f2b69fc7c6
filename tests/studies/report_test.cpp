// report.html and study.json: whole, self-contained, and nothing in them can break out.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <set>

#include "base/atomic_file.h"
#include "mesh/generate.h"
#include "studies/published.h"
#include "studies/report.h"
#include "tests/support/run_command.h"

namespace rhexis::studies {
namespace {

using nlohmann::ordered_json;
using testing::HasSubstr;
using testing::Not;

const StudyRun kRun{
    .study = "one", .title = "A < B & \"C\"", .command = "rhexis study one --out out", .seconds = 1.5, .threads = 2};

/// A tube that swells, coloured.
result::ShapePicture picture() {
  result::ShapePicture out{.title = "</script><b>", .surface = result::surface_of(*mesh::make_tube({}, 60))};
  result::ShapePanel panel{.title = "swollen"};
  for (const Vec3& x : out.surface.nodes) panel.displacement.push_back(0.1 * x);
  for (std::size_t f = 0; f < out.surface.faces.size(); ++f) panel.values.push_back(static_cast<double>(f));
  out.panels.push_back(panel);
  out.field = "lambda";
  out.unit = "Pa";
  return out;
}

StudyFolder folder_with_all(const std::filesystem::path& path) {
  const StudyFolder folder = *StudyFolder::open(path);
  EXPECT_TRUE(folder.write_table("rows", {{{"name", "<i>"}, {"value", 0.125}}}, "What it holds."));
  EXPECT_TRUE(folder.write_figure("line", {.title = "a line", .series = {{.name = "a", .x = {1.0}, .y = {2.0}}}}));
  EXPECT_TRUE(folder.write_shapes("body", picture()));
  folder.note("An honest word.");
  folder.compare("timing.build.linear", 0.18, "other hardware");
  return folder;
}

TEST(Report, HoldsAllThatWasWritten) {
  const std::filesystem::path path = test::fresh_folder("report");
  const StudyFolder folder = folder_with_all(path);
  ASSERT_TRUE(write_report(folder, kRun, path / "no-viewer.js"));
  const std::string html = test::slurp(path / "report.html");
  for (const char* part :
       {"A &lt; B &amp; &quot;C&quot;", "An honest word.", "&lt;i&gt;", "0.125", "a line", "rhexis study one --out out",
        "other hardware", "paper, Table 6", "make viewer", "prefers-color-scheme", "@media print"})
    EXPECT_THAT(html, HasSubstr(part));
  EXPECT_THAT(html, Not(HasSubstr("http://www.w3.org/1999")));
  EXPECT_THAT(html, Not(HasSubstr("src=\"")));

  const auto about = ordered_json::parse(test::slurp(path / "study.json"));
  EXPECT_EQ(about["study"], "one");
  EXPECT_EQ(about["tables"], ordered_json({"rows"}));
  EXPECT_EQ(about["figures"], ordered_json({"line", "body"}));
  ASSERT_EQ(about["published"].size(), 1U);
  EXPECT_DOUBLE_EQ(about["published"][0]["ratio"], 2.0);
  EXPECT_GE(about["machine"]["cores"], 1);
}

TEST(Report, TurnsShapesWithTheScriptOfThePage) {
  const std::filesystem::path path = test::fresh_folder("report");
  const StudyFolder folder = folder_with_all(path);
  ASSERT_TRUE(write_atomically(path / "viewer.js", "run('</script>')"));
  ASSERT_TRUE(write_report(folder, kRun, path / "viewer.js"));
  const std::string html = test::slurp(path / "report.html");
  EXPECT_THAT(html, HasSubstr("run('<\\/script>')"));
  EXPECT_THAT(html, HasSubstr("\"signed\":false"));
  EXPECT_THAT(html, Not(HasSubstr("</script><b>")));
  EXPECT_THAT(html, Not(HasSubstr("make viewer")));
}

TEST(Report, ALaterTableOfTheSameNameReplacesTheFirst) {
  const StudyFolder folder = *StudyFolder::open(test::fresh_folder("report"));
  ASSERT_TRUE(folder.write_table("rows", {{{"value", 1}}}));
  ASSERT_TRUE(folder.write_table("rows", {{{"value", 2}}}));
  ASSERT_EQ(folder.contents().items.size(), 1U);
  EXPECT_EQ(std::get<StudyTable>(folder.contents().items.front()).rows[0]["value"], 2);
  folder.compare("timing.build.linear", 1.0, "");
  folder.compare("timing.build.linear", nullptr, "not measured");
  ASSERT_EQ(folder.contents().published.size(), 1U);
  EXPECT_TRUE(folder.contents().published[0]["ratio"].is_null());
}

TEST(Report, AnIndexLinksTheReports) {
  const std::filesystem::path path = test::fresh_folder("report");
  ASSERT_TRUE(write_report_index(path, {kRun}));
  EXPECT_THAT(test::slurp(path / "index.html"), HasSubstr("href=\"one/report.html\""));
}

TEST(Published, EveryNumberHasItsOwnNameAndOneValueOrTrend) {
  std::set<std::string_view> seen;
  for (const Published& one : published_numbers()) {
    EXPECT_TRUE(seen.insert(one.id).second) << one.id;
    EXPECT_NE(one.value.has_value(), !one.trend.empty()) << one.id;
    EXPECT_FALSE(one.source.empty()) << one.id;
  }
}

TEST(ShapePicture, TheSurfaceOfATubeIsClosedAndSeenFromOutside) {
  const mesh::TetMesh tube = *mesh::make_tube({.wall = 0.002}, 200);
  const result::ShapeSurface surface = result::surface_of(tube);
  double volume = 0.0;
  for (const auto& [a, b, c] : surface.faces)
    volume += surface.nodes[static_cast<std::size_t>(a)].dot(
                  surface.nodes[static_cast<std::size_t>(b)].cross(surface.nodes[static_cast<std::size_t>(c)])) /
              6.0;
  EXPECT_NEAR(volume, mesh::total_volume(tube), 1e-12 * volume);
}

TEST(ShapePicture, TheColoursEndAtARoundNumber) {
  result::ShapePicture one = picture();
  one.panels[0].values.assign(one.surface.faces.size(), 1.2e5);
  EXPECT_EQ(result::top_of(one), 1.5e5);
  one.panels[0].values.clear();
  EXPECT_EQ(result::top_of(one), 0.0);
  EXPECT_EQ(result::shape_svg(picture()), result::shape_svg(picture()));
}

}  // namespace
}  // namespace rhexis::studies
