#include "result/chart.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>
#include <sstream>

#include <pugixml.hpp>

#include "tests/support/run_command.h"

namespace rhexis::result {
namespace {

using testing::HasSubstr;
using testing::Not;

/// Two lines, symbols of another source with whiskers, and events.
Chart example() {
  Chart chart;
  chart.title = "Force at the hand";
  chart.x.label = "time / s";
  chart.y.label = "force / N";
  ChartSeries force{.name = "magnitude"};
  ChartSeries other{.name = "x", .dashed = true};
  for (int i = 0; i <= 20; ++i) {
    force.x.push_back(0.1 * i);
    force.y.push_back(std::abs(std::sin(0.4 * i)));
    other.x.push_back(0.1 * i);
    other.y.push_back(-0.05 * i);
  }
  chart.series = {force, other};
  chart.marks = {{"advance", {0.5, 1.25}}};
  return chart;
}

ChartSeries measured() {
  return {.name = "measured", .x = {1.0, 10.0}, .y = {2.0, 3.0}, .low = {1.5, 2.5}, .high = {2.5, 4.0}};
}

pugi::xml_document parsed(const Chart& chart) {
  const Expected<std::string> svg = chart_svg(chart);
  EXPECT_TRUE(svg) << svg.error().message();
  pugi::xml_document document;
  const pugi::xml_parse_result result = document.load_string(svg ? svg->c_str() : "");
  EXPECT_TRUE(result) << result.description();
  return document;
}

std::size_t count(const pugi::xml_document& document, const std::string& xpath) {
  return document.select_nodes(xpath.c_str()).size();
}

std::string error_of(const Chart& chart) {
  const Expected<std::string> svg = chart_svg(chart);
  return svg ? "" : svg.error().message();
}

/// The numbers of an attribute, letters and commas left out.
std::vector<double> numbers(std::string text) {
  for (char& c : text)
    if (std::isalpha(static_cast<unsigned char>(c)) != 0) c = ' ';
  std::istringstream stream(text);
  std::vector<double> out;
  for (double value = 0.0; stream >> value;) out.push_back(value);
  return out;
}

TEST(Chart, IsWellFormedWithWhatItWasGiven) {
  const pugi::xml_document document = parsed(example());
  EXPECT_STREQ(document.child("svg").child_value("title"), "Force at the hand");
  for (const char* text : {"Force at the hand", "time / s", "force / N", "magnitude", "x", "advance"})
    EXPECT_EQ(count(document, std::string("//text[.='") + text + "']"), 1U) << text;
  EXPECT_EQ(count(document, "//path[starts-with(@class, 'line ')]"), 4U);  // two lines, and their samples
  EXPECT_EQ(count(document, "//path[contains(@class, 'dashed')]"), 2U);
  EXPECT_EQ(count(document, "//path[@class='mark']"), 2U);
  EXPECT_EQ(count(document, "//text[.='0.5' or .='1.0' or .='2.0']"), 3U + 1U);  // 0.5 stands at both axes
}

TEST(Chart, NeedsNothingFromOutside) {
  const std::string svg = *chart_svg(example());
  for (const char* reference : {"href", "url(", "<script", "@import", "<image"})
    EXPECT_THAT(svg, Not(HasSubstr(reference)));
  EXPECT_THAT(svg, HasSubstr("prefers-color-scheme:dark"));
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
  EXPECT_THAT(svg, Not(HasSubstr("inf")));
}

TEST(Chart, EveryRuleStaysWithinTheChart) {
  const pugi::xml_document document = parsed(example());
  std::istringstream style(document.child("svg").child_value("style"));
  std::size_t rules = 0;
  for (std::string rule; std::getline(style, rule, '}');) {
    rule.erase(0, rule.find_first_not_of(" \n"));
    if (rule.starts_with("@media")) rule.erase(0, rule.find('{') + 2);
    if (rule.empty()) continue;
    EXPECT_TRUE(rule.starts_with(".rhexis-chart ")) << rule;
    ++rules;
  }
  EXPECT_GT(rules, 20U);
}

TEST(Chart, TheSameChartGivesTheSameBytes) {
  EXPECT_EQ(*chart_svg(example()), *chart_svg(example()));
  Chart other = example();
  other.series[0].y[3] += 0.1;
  EXPECT_NE(*chart_svg(example()), *chart_svg(other));
}

TEST(Chart, TextIsEscaped) {
  Chart chart = example();
  chart.title = "a < b & \"c\" > d\x01";
  chart.series[0].name = "</text><script>alert(1)</script>";
  chart.y.label = "σ₁ / Pa";
  const pugi::xml_document document = parsed(chart);
  EXPECT_STREQ(document.child("svg").child_value("title"), "a < b & \"c\" > d?");
  EXPECT_EQ(count(document, "//script"), 0U);
  EXPECT_EQ(count(document, "//text[.='σ₁ / Pa']"), 1U);
}

TEST(Chart, RefusesWhatCannotBeDrawn) {
  const double inf = std::numeric_limits<double>::infinity();
  Chart chart = example();
  chart.series[1].y[4] = std::nan("");
  EXPECT_EQ(error_of(chart), "'x' cannot be drawn: number 4 along 'force / N' is not finite");
  chart = example();
  chart.series[0].x[2] = -inf;
  EXPECT_EQ(error_of(chart), "'magnitude' cannot be drawn: number 2 along 'time / s' is not finite");
  chart = example();
  chart.series[0].y[2] = 1e200;
  EXPECT_THAT(error_of(chart), HasSubstr("is too large"));
  chart = example();
  chart.marks[0].x[1] = inf;
  EXPECT_THAT(error_of(chart), HasSubstr("'advance' cannot be drawn: number 1"));
  chart = example();
  chart.y.scale = Scale::log;
  EXPECT_THAT(error_of(chart), HasSubstr("not positive, and the axis is logarithmic"));
  chart.series = {measured()};
  chart.series[0].low[1] = 0.0;
  EXPECT_THAT(error_of(chart), HasSubstr("'measured' cannot be drawn: number 1"));
  EXPECT_EQ(error_of(Chart{.title = "Empty"}), "chart 'Empty' has no point to draw");
}

TEST(Chart, DrawsTheLargestAndSmallestNumbersThatItTakes) {
  for (const Scale scale : {Scale::linear, Scale::log}) {
    for (const double value : {kLargestDrawn, 1.0 / kLargestDrawn}) {
      Chart chart = example();
      chart.y.scale = scale;
      chart.series = {{.name = "one", .x = {0.0, 1.0}, .y = {value, value}}};
      EXPECT_EQ(error_of(chart), "");
      chart.series[0].y[0] = 1.0;
      EXPECT_EQ(error_of(chart), "");
    }
  }
}

TEST(Chart, SymbolsOfEveryKindStandWhereTheyShould) {
  Chart chart;
  chart.x = {.label = "nodes", .scale = Scale::log};
  chart.y = {.label = "ms", .scale = Scale::log};
  for (const Symbol symbol : {Symbol::circle, Symbol::square, Symbol::triangle, Symbol::diamond}) {
    ChartSeries series = measured();
    series.symbol = symbol;
    series.hollow = symbol == Symbol::triangle;
    chart.series.push_back(series);
  }
  const pugi::xml_document document = parsed(chart);
  EXPECT_EQ(count(document, "//*[starts-with(@class, 'symbol')]"), 4U * 3U);  // two points each and the legend
  EXPECT_EQ(count(document, "//*[starts-with(@class, 'symbol h')]"), 3U);
  EXPECT_EQ(count(document, "//circle"), 3U);
  EXPECT_EQ(count(document, "//path[contains(@style, 'stroke-width')]"), 4U);  // whiskers

  // A decade to the right and half a decade up: the places of the two circles in the plot tell the scale.
  const pugi::xpath_node_set circles = document.select_nodes("//circle[@cx > 20]");
  ASSERT_EQ(circles.size(), 2U);
  EXPECT_LT(circles[0].node().attribute("cx").as_double(), circles[1].node().attribute("cx").as_double());
  EXPECT_GT(circles[0].node().attribute("cy").as_double(), circles[1].node().attribute("cy").as_double());
}

TEST(Chart, ALineOfManyPointsIsThinnedAndKeepsItsPeaks) {
  Chart chart = example();
  ChartSeries noise{.name = "noise"};
  for (int i = 0; i < 200000; ++i) {
    noise.x.push_back(i * 1e-3);
    noise.y.push_back(i == 123457 ? 50.0 : i == 77777 ? -40.0 : std::sin(i * 0.7));
  }
  chart.series = {noise};
  const std::string svg = *chart_svg(chart);
  EXPECT_LT(svg.size(), 120000U);
  const pugi::xml_document document = parsed(chart);
  const std::vector<double> path =
      numbers(document.select_nodes("//path[@class='line c0']")[1].node().attribute("d").value());
  double top = 1e9;
  double bottom = 0.0;
  for (std::size_t i = 1; i < path.size(); i += 2) {
    top = std::min(top, path[i]);
    bottom = std::max(bottom, path[i]);
  }
  // From -40 to 50, with 5% of air at both ends.
  EXPECT_NEAR(top / bottom, 4.5 / 94.5, 1e-3);
}

TEST(Chart, ALongLegendIsWrapped) {
  Chart chart = example();
  for (int k = 0; k < 9; ++k) chart.series.push_back(chart.series[0]);
  for (const int width : {300, 860}) {
    chart.width = width;
    const pugi::xml_document document = parsed(chart);
    for (const pugi::xpath_node& entry : document.select_nodes("/svg/g")) {
      const std::vector<double> at = numbers(std::string(entry.node().attribute("transform").value()).substr(10));
      ASSERT_FALSE(at.empty());
      EXPECT_LT(at[0], width);
    }
  }
}

TEST(Chart, IsWrittenWhole) {
  const std::filesystem::path folder = test::fresh_folder("chart");
  ASSERT_TRUE(write_chart(folder / "deep" / "force.svg", example()));
  EXPECT_EQ(test::slurp(folder / "deep" / "force.svg"), *chart_svg(example()));
  const Expected<void> refused = write_chart(folder / "none.svg", Chart{.title = "Empty"});
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message(), HasSubstr("none.svg: chart 'Empty' has no point"));
  EXPECT_FALSE(std::filesystem::exists(folder / "none.svg"));
}

}  // namespace
}  // namespace rhexis::result
