#include "studies/angle_perception_figures.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace rhexis::studies {
namespace {

using nlohmann::ordered_json;
using result::Chart;
using result::ChartSeries;
using result::Symbol;

constexpr int kCurvePoints = 120;
/// degrees, what a curve is drawn over.
constexpr double kCurveFrom = 1.0, kCurveTo = 90.0;
constexpr Symbol kSymbols[] = {Symbol::circle, Symbol::square, Symbol::diamond};

/// The last series, or `fresh` behind it where that has another name.
ChartSeries& series_of(Chart& chart, ChartSeries fresh) {
  if (chart.series.empty() || chart.series.back().name != fresh.name) chart.series.push_back(std::move(fresh));
  return chart.series.back();
}

}  // namespace

Chart answers_chart(const std::string& title, std::span<const AnswerCount> answers,
                    const std::optional<PsychometricFit>& fit) {
  Chart chart;
  chart.title = title;
  chart.subtitle = "Whiskers: one standard error of the part";
  chart.x = {.label = "difference of the crack angle / degrees", .scale = result::Scale::log};
  chart.y = {.label = "part of right answers"};
  ChartSeries counted{.name = "answers", .line = false, .symbol = Symbol::circle, .colour = 0};
  for (const AnswerCount& count : answers) {
    if (count.trials == 0) continue;
    const double part = static_cast<double>(count.right) / count.trials;
    const double error = std::sqrt(part * (1.0 - part) / count.trials);
    counted.x.push_back(count.difference);
    counted.y.push_back(part);
    counted.low.push_back(std::max(0.0, part - error));
    counted.high.push_back(std::min(1.0, part + error));
  }
  ChartSeries curve{.name = "fitted", .colour = 1};
  ChartSeries guess{
      .name = "guessing", .x = {kCurveFrom, kCurveTo}, .y = {kGuess, kGuess}, .dashed = true, .colour = 5};
  for (int k = 0; fit && k <= kCurvePoints; ++k) {
    const double x = kCurveFrom * std::pow(kCurveTo / kCurveFrom, static_cast<double>(k) / kCurvePoints);
    curve.x.push_back(x);
    curve.y.push_back(fit->function.probability(x));
  }
  for (ChartSeries* series : {&guess, &curve, &counted})
    if (!series->x.empty()) chart.series.push_back(std::move(*series));
  return chart;
}

Chart rules_chart(const ordered_json& rows) {
  Chart chart;
  chart.title = "What each rule finds of a simulated observer's threshold";
  chart.subtitle = "Fitted over true threshold; whiskers: one standard deviation of single observers";
  chart.x = {.label = "true threshold / degrees", .scale = result::Scale::log};
  chart.y = {.label = "fitted / true", .scale = result::Scale::log};
  int rule = -1;
  for (const ordered_json& row : rows) {
    const auto name = row.at("rule").get<std::string>();
    if (chart.series.empty() || chart.series.back().name != name) ++rule;
    ChartSeries& series =
        series_of(chart, {.name = name, .symbol = kSymbols[static_cast<std::size_t>(rule) % std::size(kSymbols)]});
    const double ratio = 1.0 + 0.01 * row.at("bias_percent").get<double>();
    const double factor = 1.0 + 0.01 * row.at("spread_percent").get<double>();
    // Beside each other, so that whiskers do not lie on whiskers.
    series.x.push_back(row.at("threshold").get<double>() * (1.0 + 0.02 * rule));
    series.y.push_back(ratio);
    series.low.push_back(ratio / factor);
    series.high.push_back(ratio * factor);
  }
  return chart;
}

Chart feel_chart(const ordered_json& rows) {
  Chart chart;
  chart.title = "What there is to feel of a crack that runs another way";
  chart.subtitle = "Length of the change of the force, in percent of the sample's, at the same pull";
  chart.x = {.label = "difference of the crack angle / degrees", .scale = result::Scale::log};
  chart.y = {.label = "change of the force / %", .scale = result::Scale::log};
  for (const ordered_json& row : rows) {
    const std::string name =
        fmt::format("point {}, direction {}", row.at("point").get<int>() + 1, row.at("direction").get<int>() + 1);
    const auto direction = row.at("direction").get<std::size_t>();
    ChartSeries& series = series_of(chart, {.name = name,
                                            .dashed = row.at("point").get<int>() > 0,
                                            .symbol = kSymbols[direction % std::size(kSymbols)],
                                            .colour = static_cast<int>(direction) % result::kChartColours});
    series.x.push_back(row.at("difference"));
    series.y.push_back(row.at("change_percent"));
  }
  return chart;
}

}  // namespace rhexis::studies
