#include "studies/live_study.h"

#include <algorithm>

#include "haptics/tick_settings.h"

namespace rhexis::studies {
namespace {

constexpr double kMs = 1e-6;  // of a nanosecond

}  // namespace

Latencies latencies_of(const LiveRun& run) {
  Latencies out;
  for (std::size_t tick = 1; tick < run.marks.size(); ++tick) {
    const TickMark& mark = run.marks[tick];
    if (!mark.moved || !mark.pushed) continue;
    out.to_force.push_back(kMs * static_cast<double>(mark.written - mark.read));
    out.to_force_at_most.push_back(kMs * static_cast<double>(mark.written - run.marks[tick - 1].read));
  }
  for (const WatchRecord& client : run.clients) {
    std::vector<double>& waited = out.to_picture.emplace_back();
    std::size_t tick = client.states.empty() ? 0 : client.states.front().tick + 1;  // from the first picture on
    for (const SeenState& state : client.states) {
      for (; tick <= state.tick && tick < run.marks.size(); ++tick)
        if (run.marks[tick].moved) waited.push_back(kMs * static_cast<double>(state.at - run.marks[tick].read));
    }
  }
  return out;
}

Expected<nlohmann::ordered_json> run_live_study(const LiveOptions& options, const StudyFolder& folder,
                                                const Progress& progress) {
  const Expected<LiveRun> run = run_live(options, folder, progress);
  if (!run) return fail(run.error());
  if (run->ticks.ticks < 2 || run->marks.size() < 2) return fail("not a tick was made", "more --seconds");
  const bool all_see = std::all_of(run->clients.begin(), run->clients.end(),
                                   [](const WatchRecord& client) { return !client.states.empty(); });
  if (!all_see) return fail("a client has seen no State", "more --seconds");
  const Latencies latencies = latencies_of(*run);
  nlohmann::ordered_json measures = live_measures(*run, latencies);
  const nlohmann::ordered_json histograms = live_histograms(*run, latencies);
  Expected<void> done = folder.write_table("live", measures);
  if (done) done = folder.write_table("live-histograms", histograms);
  if (done) done = folder.write_table("live-clients", live_clients(*run, latencies));
  if (done)
    done = folder.write_figure("live-ticks", live_chart(histograms, "The ticks of the haptic loop", {"tick", "law"}));
  if (done) done = folder.write_figure("live-latency", live_chart(histograms, "What a hand waits for", {"hand"}));
  if (!done) return fail(std::move(done.error()));
  return measures;
}

result::Chart live_chart(const nlohmann::ordered_json& histograms, const std::string& title,
                         const std::vector<std::string>& names) {
  const auto is_asked_for = [&](const nlohmann::ordered_json& bin) {
    const auto name = bin.at("histogram").get<std::string>();
    return std::any_of(names.begin(), names.end(), [&](const std::string& of) { return name.starts_with(of); });
  };
  double ground = 1.0;  // a logarithm has no zero: what is empty lies below all that is not
  for (const nlohmann::ordered_json& bin : histograms)
    if (is_asked_for(bin)) ground = std::min(ground, 0.5 * bin.at("part").get<double>());
  result::Chart chart;
  chart.title = title;
  chart.subtitle = "Half-octave bins; one that is empty lies on the ground";
  chart.x = {.label = "time / ms", .scale = result::Scale::log};
  chart.y = {.label = "part of all", .scale = result::Scale::log};
  chart.marks.push_back({.name = "a period of the loop", .x = {1e3 * haptics::kTickSeconds}});
  for (const nlohmann::ordered_json& bin : histograms) {
    if (!is_asked_for(bin)) continue;
    const double to = bin.at("to_ms");
    const double from = std::max(bin.at("from_ms").get<double>(), 0.5 * to);  // nor has it one on the other axis
    const auto name = bin.at("histogram").get<std::string>();
    if (chart.series.empty() || chart.series.back().name != name)
      chart.series.push_back({.name = name, .x = {from}, .y = {ground}});
    result::ChartSeries& series = chart.series.back();
    const auto add = [&](double x, double y) {
      series.x.push_back(x);
      series.y.push_back(y);
    };
    if (from > series.x.back()) {
      add(series.x.back(), ground);
      add(from, ground);
    }
    add(from, bin.at("part"));
    add(to, bin.at("part"));
  }
  for (result::ChartSeries& series : chart.series) {
    series.x.push_back(series.x.back());
    series.y.push_back(ground);
  }
  return chart;
}

}  // namespace rhexis::studies
