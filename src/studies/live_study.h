#pragma once

/// How punctual a live session is (docs/haptics.md): its haptic loop, the laws that it feels, the pictures of those who
/// watch.

#include <nlohmann/json.hpp>

#include "result/chart.h"
#include "studies/live_run.h"

namespace rhexis::studies {

/// Runs it, and writes live.csv and .json (what is returned: a row a measure, of `measure`, `value`, `unit`, `note`),
/// live-histograms.csv and .json (a row a bin that holds something, of `histogram`, `from_ms`, `to_ms`, `count`,
/// `part`), live-clients.csv and .json (a row a client), live-ticks.svg and live-latency.svg. Errors as of run_live, or
/// a run without a tick or a State.
Expected<nlohmann::ordered_json> run_live_study(const LiveOptions& options, const StudyFolder& folder,
                                                const Progress& progress);

/// ms, each: what one hand has to wait for.
struct Latencies {
  /// Of every tick in which the hand was at another place and a force was written: from its reading to the force; and
  /// from the reading before, which is what a hand waits that moved just after that.
  std::vector<double> to_force, to_force_at_most;
  /// Of every tick in which the hand was at another place, for each client: from its reading until a State of that tick
  /// or a later one was decoded.
  std::vector<std::vector<double>> to_picture;
};
[[nodiscard]] Latencies latencies_of(const LiveRun& run);

/// The tables, without running anything.
[[nodiscard]] nlohmann::ordered_json live_measures(const LiveRun& run, const Latencies& latencies);
[[nodiscard]] nlohmann::ordered_json live_histograms(const LiveRun& run, const Latencies& latencies);
[[nodiscard]] nlohmann::ordered_json live_clients(const LiveRun& run, const Latencies& latencies);

/// The histograms whose names begin with one of these, part of all over milliseconds, both logarithmic.
[[nodiscard]] result::Chart live_chart(const nlohmann::ordered_json& histograms, const std::string& title,
                                       const std::vector<std::string>& names);

}  // namespace rhexis::studies
