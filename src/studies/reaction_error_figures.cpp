#include "studies/reaction_error_figures.h"

#include <string>

#include <fmt/format.h>

#include "studies/reaction_tally.h"

namespace rhexis::studies {
namespace {

using nlohmann::ordered_json;
using result::Chart;
using result::ChartSeries;
using result::Symbol;

constexpr std::array<std::string_view, 3> kNames{"nearest recorded", "interpolated, (4.27)",
                                                 "local object solved, far field recorded"};
constexpr std::array<Symbol, 3> kSymbols{Symbol::circle, Symbol::square, Symbol::diamond};
constexpr std::array<int, 3> kColours{1, 3, 0};

/// One line of a way, from the column WAY_`what`; `suffix` goes to its name.
ChartSeries line_of(const ordered_json& rows, std::string_view x, std::size_t way, std::string_view what,
                    std::string_view suffix = "") {
  ChartSeries out;
  out.name = std::string(kNames[way]) + std::string(suffix);
  out.colour = kColours[way];
  for (const ordered_json& row : rows) {
    out.x.push_back(row.at(std::string(x)));
    out.y.push_back(row.at(fmt::format("{}_{}", kReactionWays[way], what)));
  }
  return out;
}

result::ChartMarks recorded_marks(double spacing) {
  result::ChartMarks marks{"recorded", {}};
  for (int k = 0; k * spacing <= 180.0 + 1e-9; ++k) marks.x.push_back(k * spacing);
  return marks;
}

}  // namespace

ForceCurve::ForceCurve(const std::vector<Vec3>& points, const Vec3& at, const Vec3& by) : pull_(by) {
  for (std::size_t k = 0; k < points.size(); ++k) {
    if ((points[k] - at).norm() < (points[point_] - at).norm()) point_ = k;
  }
}

void ForceCurve::add(const ReactionQuery& query, const ForceCurve& of) {
  for (const ReactionSample& sample : query.samples) {
    if (sample.point != of.point_) continue;
    angle_.push_back(query.angles.back());
    force_.push_back({(sample.exact * of.pull_).norm(), (sample.nearest * of.pull_).norm(),
                      (sample.linear * of.pull_).norm(), (sample.local * of.pull_).norm()});
  }
}

void ForceCurve::append(const ForceCurve& other) {
  angle_.insert(angle_.end(), other.angle_.begin(), other.angle_.end());
  force_.insert(force_.end(), other.force_.begin(), other.force_.end());
}

ordered_json ForceCurve::rows() const {
  ordered_json out = ordered_json::array();
  for (std::size_t k = 0; k < angle_.size(); ++k) {
    ordered_json row{{"angle", angle_[k]}, {"exact_N", force_[k][0]}};
    for (std::size_t way = 0; way < kReactionWays.size(); ++way)
      row[fmt::format("{}_N", kReactionWays[way])] = force_[k][way + 1];
    out.push_back(std::move(row));
  }
  return out;
}

Chart spacing_chart(const ordered_json& rows) {
  Chart chart;
  chart.title = "Error of the force over the spacing of the record";
  chart.subtitle =
      "One advance of 40.3 mm at every degree, all grasp points and pulls; mean of |error| / |exact force|";
  chart.x = {.label = "degrees between recorded cracks", .scale = result::Scale::log};
  chart.y = {.label = "mean relative error", .scale = result::Scale::log};
  for (std::size_t way = 0; way < kReactionWays.size(); ++way) {
    chart.series.push_back(line_of(rows, "spacing", way, "relative"));
    chart.series.back().symbol = kSymbols[way];
  }
  return chart;
}

Chart distance_chart(const ordered_json& rows) {
  Chart chart;
  chart.title = "Error of the force over the distance of the hand from the crack";
  chart.subtitle = "Mean of |error| / |exact force| in classes of 10 mm; recorded every 15 degrees";
  chart.x = {.label = "distance of the grasp point from the crack / mm"};
  chart.y = {.label = "mean relative error", .scale = result::Scale::log};
  for (const int advances : {1, 2}) {
    ordered_json some = ordered_json::array();
    for (const ordered_json& row : rows) {
      if (row.at("advances") == advances) some.push_back(row);
    }
    if (some.empty()) continue;
    for (std::size_t way = 0; way < kReactionWays.size(); ++way) {
      chart.series.push_back(line_of(some, "distance_mm", way, "relative", advances == 1 ? ", one advance" : ", two"));
      chart.series.back().symbol = kSymbols[way];
      chart.series.back().dashed = advances == 2;
    }
  }
  chart.height = 560;
  return chart;
}

Chart angle_chart(const ordered_json& rows, double spacing) {
  Chart chart;
  chart.title = "Error of the force over the angle of the crack";
  chart.subtitle = "One advance of 40.3 mm, mean over all grasp points and pulls of 120 mm";
  chart.x = {.label = "angle of the advance / degrees"};
  chart.y = {.label = "mean error / N"};
  for (std::size_t way = 0; way < kReactionWays.size(); ++way) chart.series.push_back(line_of(rows, "angle", way, "N"));
  chart.marks.push_back(recorded_marks(spacing));
  return chart;
}

Chart force_chart(const ordered_json& rows, double spacing) {
  Chart chart;
  chart.title = "What the hand feels beside the crack, over the angle of the crack";
  chart.subtitle = "One advance of 40.3 mm; the point of scenes/plate-tear.toml pulled by 120 mm";
  chart.x = {.label = "angle of the advance / degrees"};
  chart.y = {.label = "force / N"};
  ChartSeries exact;
  exact.name = "exact";
  exact.colour = 5;
  for (const ordered_json& row : rows) {
    exact.x.push_back(row.at("angle"));
    exact.y.push_back(row.at("exact_N"));
  }
  for (std::size_t way = 0; way < kReactionWays.size(); ++way) chart.series.push_back(line_of(rows, "angle", way, "N"));
  chart.series.push_back(std::move(exact));
  chart.series.back().dashed = true;
  chart.marks.push_back(recorded_marks(spacing));
  return chart;
}

}  // namespace rhexis::studies
