#include "studies/stability_map.h"

#include <cmath>
#include <string>

#include <fmt/format.h>

#include "studies/closed_loop.h"

namespace rhexis::studies {
namespace {

using nlohmann::ordered_json;

Expected<ordered_json> one_row(const StabilityOptions& options, double stiffness, int delay) {
  ClosedLoop loop;
  loop.device = options.device;
  loop.device.delay = delay;
  loop.ticks = static_cast<int>(std::lround(options.seconds / haptics::kTickSeconds));
  loop.tick = haptics::settings_for(haptics::EmulatorDevice::make_traits(loop.device));
  loop.tick.stiffness = stiffness;
  loop.tick.damping = options.damping;
  const double bound = stable_stiffness(loop.tick, loop.device);
  ordered_json row;
  row["stiffness"] = stiffness;
  row["delay_ms"] = 1e3 * haptics::kTickSeconds * delay;
  row["bound"] = bound;
  row["over_bound"] = stiffness / bound;
  for (const bool restrains : {false, true}) {
    loop.tick.restrains = restrains;
    const Expected<ClosedLoopRun> run = run_closed_loop(loop);
    if (!run) return fail(run.error());
    const std::string of = restrains ? "_kept" : "_free";
    row["rests" + of] = run->shake < kAtRest;
    row["shake_mm" + of] = 1e3 * run->shake;
    row["force_N" + of] = run->force;
    row["given_mJ" + of] = 1e3 * run->given;
    if (restrains) row["gain"] = run->gain;
  }
  return row;
}

}  // namespace

Expected<ordered_json> run_stability_map(const StabilityOptions& options, const StudyFolder& folder,
                                         const Progress& progress) {
  ordered_json rows = ordered_json::array();
  const auto all = static_cast<double>(options.stiffness.size() * options.delay.size());
  bool goes_on = true;
  for (const int delay : options.delay) {
    for (const double stiffness : options.stiffness) {
      if (!goes_on) break;
      Expected<ordered_json> row = one_row(options, stiffness, delay);
      if (!row) return fail(row.error());
      rows.push_back(std::move(*row));
      goes_on = progress(static_cast<double>(rows.size()) / all, fmt::format("{} N/m, {} ms", stiffness, delay));
    }
  }
  if (rows.empty()) return fail("no stiffness or no delay was asked for", "one of each at least");
  if (Expected<void> done = folder.write_table("haptic-stability", rows); !done) return fail(done.error());
  if (Expected<void> done = folder.write_figure("haptic-stability", stability_chart(rows)); !done)
    return fail(done.error());
  return rows;
}

result::Chart stability_chart(const ordered_json& rows) {
  using result::ChartSeries;
  using result::Symbol;
  result::Chart chart;
  chart.title = "What an emulated device bears";
  chart.subtitle = "Coupling before a stiff body, a hand that holds loosely jumps aside once";
  chart.x = {.label = "delay of the force / ms"};
  chart.y = {.label = "stiffness of the coupling / N/m", .scale = result::Scale::log};
  chart.height = 560;
  ChartSeries by_itself{.name = "rests by itself", .line = false, .symbol = Symbol::circle, .colour = 2};
  ChartSeries kept{.name = "rests with control of energy", .line = false, .symbol = Symbol::diamond, .colour = 0};
  ChartSeries shakes{.name = "shakes", .line = false, .symbol = Symbol::triangle, .hollow = true, .colour = 1};
  ChartSeries bound{.name = "k (T/2 + delay) = damping", .colour = 5};
  for (const ordered_json& row : rows) {
    ChartSeries& series = row.at("rests_free") ? by_itself : row.at("rests_kept") ? kept : shakes;
    series.x.push_back(row.at("delay_ms"));
    series.y.push_back(row.at("stiffness"));
    if (!bound.x.empty() && bound.x.back() == row.at("delay_ms").get<double>()) continue;
    bound.x.push_back(row.at("delay_ms"));
    bound.y.push_back(row.at("bound"));
  }
  for (ChartSeries* series : {&by_itself, &kept, &shakes, &bound})
    if (!series->x.empty()) chart.series.push_back(std::move(*series));
  return chart;
}

}  // namespace rhexis::studies
