#include <fmt/format.h>

#include "studies/published.h"
#include "studies/restructuring.h"

namespace rhexis::studies {
namespace {

using nlohmann::ordered_json;
using result::ChartSeries;
using result::Symbol;

/// One line of the figure.
struct Line {
  std::string_view mode;
  std::string_view way;
  std::string_view name;
  Symbol symbol;
  int colour;
};

/// What depends on the mode is drawn for both, dashed where it is imposed; a full solve does not, and is drawn for the
/// slow pull, whose bodies are more.
constexpr std::array<Line, 7> kLines{{
    {"slow-pull", "dense-inverse", "whole body, dense inverse", Symbol::circle, 1},
    {"slow-pull", "sparse", "whole body, sparse factor", Symbol::square, 4},
    {"slow-pull", "local", "local object, slow pull", Symbol::triangle, 2},
    {"imposed", "local", "local object, 40.3 mm", Symbol::triangle, 2},
    {"slow-pull", "exact-all-work", "exact, all work waited for", Symbol::diamond, 3},
    {"slow-pull", "exact", "exact, slow pull", Symbol::diamond, 0},
    {"imposed", "exact", "exact, 40.3 mm", Symbol::diamond, 0},
}};

}  // namespace

result::Chart restructuring_chart(const ordered_json& rows) {
  result::Chart chart;
  chart.title = "Restructuring time per advance";
  chart.subtitle = "The plate of the thesis torn on by one advance; mean, with whiskers from the least to the most";
  chart.x = {.label = "nodes", .scale = result::Scale::log};
  chart.y = {.label = "time per advance / ms", .scale = result::Scale::log};
  chart.height = 560;
  for (const Line& line : kLines) {
    ChartSeries series;
    series.name = line.name;
    series.symbol = line.symbol;
    series.colour = line.colour;
    series.dashed = line.mode == "imposed";
    for (const ordered_json& row : rows) {
      if (row.at("mode") != line.mode || row.at("way") != line.way) continue;
      series.x.push_back(row.at("nodes"));
      series.y.push_back(row.at("ms_per_advance"));
      series.low.push_back(row.at("ms_least"));
      series.high.push_back(row.at("ms_most"));
    }
    if (!series.x.empty()) chart.series.push_back(std::move(series));
  }
  for (const bool whole : {true, false}) {
    ChartSeries series;
    series.name = whole ? "thesis: whole inverse" : "thesis: local object";
    for (const int nodes : kThesisNodes) {  // 40.3 mm imposed, another machine
      series.x.push_back(nodes);
      series.y.push_back(published_value(fmt::format("restructuring.{}.{}", whole ? "whole" : "local", nodes)));
    }
    series.line = false;
    series.hollow = true;
    series.symbol = whole ? Symbol::circle : Symbol::triangle;
    series.colour = 5;
    chart.series.push_back(std::move(series));
  }
  return chart;
}

}  // namespace rhexis::studies
