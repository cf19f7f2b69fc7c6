#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "haptics/tick_settings.h"
#include "studies/live_study.h"

namespace rhexis::studies {
namespace {

using haptics::Histogram;
using nlohmann::ordered_json;

constexpr double kTickMs = 1e3 * haptics::kTickSeconds;
constexpr double kUs = 1e-3;  // ms

/// What a picture has to come at, a second.
constexpr double kFrames = 30.0;

/// The smallest value that is not exceeded by that part of all; `values` are put in another order.
double quantile(std::vector<double>& values, double part) {
  if (values.empty()) return std::nan("");
  const auto place = static_cast<std::size_t>(std::ceil(part * static_cast<double>(values.size())));
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(std::clamp<std::size_t>(place, 1, values.size()) - 1);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// The upper edge of the bin in which that part of all is reached.
double quantile(const Histogram& histogram, double part) {
  std::uint64_t below = 0;
  const double wanted = part * static_cast<double>(histogram.total());
  for (std::size_t bin = 0; bin < Histogram::kBins; ++bin) {
    below += histogram.count[bin];
    if (below > 0 && static_cast<double>(below) >= wanted) return Histogram::upper_edge(bin);
  }
  return std::nan("");
}

std::string cause_text(haptics::LateCause cause) {
  switch (cause) {
    case haptics::LateCause::woken_late: return "the system woke the thread late";
    case haptics::LateCause::interrupted: return "the system took the processor away in the tick before";
    case haptics::LateCause::own_work: return "the tick before took long by itself";
    case haptics::LateCause::none: break;
  }
  return "none";
}

/// What the marks and the frames know of a span of ticks that ends with `tick`.
std::string circumstances(const LiveRun& run, std::uint64_t tick, std::uint64_t span) {
  if (tick >= run.marks.size() || span > tick) return "not noted";
  const TickMark& last = run.marks[tick];
  const TickMark& first = run.marks[tick - span];
  return fmt::format("preempted {}, page faults {}; {}", last.preempted - first.preempted, last.faults - first.faults,
                     physics_between(run.events, first.read, last.read));
}

class Measures {
 public:
  /// `value`: a number.
  void add(std::string measure, ordered_json value, std::string unit, std::string note = {}) {
    rows_.push_back({{"measure", std::move(measure)},
                     {"value", std::move(value)},
                     {"unit", std::move(unit)},
                     {"note", std::move(note)}});
  }
  /// Median, the last percent and the worst, in ms.
  void add_spread(const std::string& of, std::vector<double> values, const std::string& note) {
    add(of + ", median", quantile(values, 0.5), "ms", note);
    add(of + ", 99%", quantile(values, 0.99), "ms");
    add(of + ", worst", quantile(values, 1.0), "ms");
  }
  [[nodiscard]] ordered_json take() { return std::move(rows_); }

 private:
  ordered_json rows_ = ordered_json::array();
};

void add_ticks(const LiveRun& run, Measures& out) {
  const haptics::TickReport& ticks = run.ticks;
  const auto due = static_cast<double>(ticks.ticks + ticks.skipped);
  out.add("ticks", ticks.ticks, "", run.priority);
  out.add("ticks within 1 ms of their time", 100.0 * (1.0 - static_cast<double>(ticks.missed) / due), "%",
          fmt::format("{} later, {} of them given up", ticks.missed, ticks.skipped));
  for (const double part : {0.5, 0.99, 0.999})
    out.add(fmt::format("tick late, {:g}% at most", 100.0 * part), kUs * quantile(ticks.late, part), "ms");
  out.add("worst tick late", kUs * ticks.worst_late, "ms",
          fmt::format("tick {}: {}; {}", ticks.worst_tick, cause_text(ticks.worst_cause),
                      circumstances(run, ticks.worst_tick, 1)));
  out.add("longest tick by itself", kUs * ticks.worst_work, "ms");
  for (const double part : {0.5, 0.99})
    out.add(fmt::format("law old, {:g}% at most", 100.0 * part), kTickMs * quantile(ticks.age, part), "ms",
            part < 0.9 ? "in ticks that hold the body" : "");
  out.add("oldest law", kTickMs * ticks.oldest, "ms",
          fmt::format("tick {}: {}", ticks.oldest_tick, circumstances(run, ticks.oldest_tick, ticks.oldest)));
}

/// States in each whole second between the first and the last.
std::vector<double> per_second(const WatchRecord& client) {
  if (client.states.empty()) return {};
  const std::int64_t begin = client.states.front().at;
  std::vector<double> out(static_cast<std::size_t>((client.states.back().at - begin) / 1'000'000'000));
  for (const SeenState& state : client.states) {
    const auto second = static_cast<std::size_t>((state.at - begin) / 1'000'000'000);
    if (second < out.size()) out[second] += 1.0;
  }
  return out;
}

double mean_rate(const WatchRecord& client) {
  const double seconds =
      client.states.empty() ? 0.0 : 1e-9 * static_cast<double>(client.states.back().at - client.states.front().at);
  return seconds > 0.0 ? static_cast<double>(client.states.size() - 1) / seconds : 0.0;
}

}  // namespace

ordered_json live_measures(const LiveRun& run, const Latencies& latencies) {
  Measures out;
  out.add("time", run.seconds, "s", fmt::format("{} pulls", run.pulls));
  add_ticks(run, out);
  double fewest = std::numeric_limits<double>::infinity();
  for (const WatchRecord& client : run.clients) fewest = std::min(fewest, mean_rate(client));
  out.add("frames to the client with the fewest", fewest, "1/s", fmt::format("of {}", run.clients.size()));
  out.add_spread("hand to force", latencies.to_force, "from the reading of the device to its force");
  out.add_spread("hand to force at most", latencies.to_force_at_most, "of a hand that moves just after a reading");
  std::vector<double> pictures;
  for (const std::vector<double>& one : latencies.to_picture) pictures.insert(pictures.end(), one.begin(), one.end());
  out.add_spread("hand to picture", std::move(pictures), "until the State of it is decoded, all clients");
  std::vector<double> steps = run.steps_per_second;
  out.add("steps of the physics, median", quantile(steps, 0.5), "1/s", "of the rates of each second");
  out.add("longest step of the physics", run.longest_step, "ms");
  out.add("advances of the crack", run.clients.front().edits, "");
  return out.take();
}

ordered_json live_histograms(const LiveRun& run, const Latencies& latencies) {
  ordered_json rows = ordered_json::array();
  const auto add = [&](const std::string& name, const Histogram& histogram, double unit) {
    for (std::size_t bin = 0; bin < Histogram::kBins; ++bin) {
      if (histogram.count[bin] == 0) continue;
      rows.push_back({{"histogram", name},
                      {"from_ms", bin == 0 ? 0.0 : unit * Histogram::upper_edge(bin - 1)},
                      {"to_ms", unit * Histogram::upper_edge(bin)},
                      {"count", histogram.count[bin]},
                      {"part", static_cast<double>(histogram.count[bin]) / static_cast<double>(histogram.total())}});
    }
  };
  const auto of = [](const std::vector<double>& values) {
    Histogram histogram;
    for (const double value : values) ++histogram.count[Histogram::bin_of(value / kUs)];
    return histogram;
  };
  add("tick after its time", run.ticks.late, kUs);
  add("law in force: its age", run.ticks.age, kTickMs);
  add("hand to force", of(latencies.to_force), kUs);
  add("hand to force at most", of(latencies.to_force_at_most), kUs);
  for (std::size_t k = 0; k < latencies.to_picture.size(); ++k)
    add(fmt::format("hand to picture, client {}", k + 1), of(latencies.to_picture[k]), kUs);
  return rows;
}

ordered_json live_clients(const LiveRun& run, const Latencies& latencies) {
  ordered_json rows = ordered_json::array();
  for (std::size_t k = 0; k < run.clients.size(); ++k) {
    const WatchRecord& client = run.clients[k];
    std::vector<double> seconds = per_second(client);
    std::vector<double> waited = latencies.to_picture[k];
    const auto enough = std::count_if(seconds.begin(), seconds.end(), [](double states) { return states >= kFrames; });
    rows.push_back({{"client", k + 1},
                    {"states", client.states.size()},
                    {"per_second", mean_rate(client)},
                    {"least_in_a_second", quantile(seconds, 0.0)},
                    {"seconds", seconds.size()},
                    {"seconds_with_30", enough},
                    {"edits", client.edits},
                    {"bodies", client.bodies},
                    {"megabytes", 1e-6 * static_cast<double>(client.bytes)},
                    {"picture_ms_median", quantile(waited, 0.5)},
                    {"picture_ms_99", quantile(waited, 0.99)},
                    {"picture_ms_worst", quantile(waited, 1.0)},
                    {"warnings", client.notices.size()}});
  }
  return rows;
}

}  // namespace rhexis::studies
