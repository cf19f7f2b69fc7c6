#include "studies/restructuring.h"

#include <algorithm>
#include <cmath>
#include <span>

#include <fmt/format.h>

#include "base/clock.h"
#include "base/nearest_name.h"
#include "studies/restructuring_case.h"

namespace rhexis::studies {
namespace {

using nlohmann::ordered_json;

Expected<void> check_names(std::string_view kind, const std::vector<std::string>& asked,
                           std::span<const std::string_view> known) {
  const std::vector<std::string> names(known.begin(), known.end());
  for (const std::string& name : asked) {
    if (std::find(names.begin(), names.end(), name) != names.end()) continue;
    const std::string near = nearest_name(name, names);
    return fail(fmt::format("unknown {} '{}'", kind, name),
                near.empty() ? fmt::format("one of {}", fmt::join(names, ", ")) : "did you mean '" + near + "'?");
  }
  return {};
}

/// How far the study has got: the cost of a case grows a little faster than its nodes.
class Advancement {
 public:
  explicit Advancement(const std::vector<int>& nodes, std::size_t modes) {
    for (const int count : nodes) all_ += static_cast<double>(modes) * cost(count);
  }
  void finish(int nodes) { done_ += cost(nodes); }
  /// `part` of the case in hand.
  [[nodiscard]] double fraction(int nodes, double part) const { return (done_ + part * cost(nodes)) / all_; }

 private:
  static double cost(int nodes) { return 5000.0 + nodes; }
  double all_ = 0.0;
  double done_ = 0.0;
};

/// Fig. 5.7 beside the same advances of ours.
void beside_the_thesis(const StudyFolder& folder, const ordered_json& rows) {
  for (const ordered_json& row : rows) {
    const int nodes = row.at("nodes");
    const auto counts = kThesisNodes;
    if (row.at("mode") != kTearModes[0] || std::find(counts.begin(), counts.end(), nodes) == counts.end()) continue;
    if (nodes == counts.front())
      folder.compare("restructuring.nodes", row.at("mesh_nodes"), "Asked for; the generator meets it within 2%.");
    if (row.at("way") == "local")
      folder.compare(fmt::format("restructuring.local.{}", nodes), row.at("ms_per_advance"),
                     "The same work on a machine and with code of twenty years later; meshes of another generator.");
    if (row.at("way") == "dense-inverse")
      folder.compare(fmt::format("restructuring.whole.{}", nodes), row.at("ms_per_advance"),
                     "The same inverse by LAPACK on one core of a machine of today.");
  }
}

}  // namespace

Expected<ordered_json> run_restructuring(const RestructuringOptions& options, const StudyFolder& folder,
                                         const Progress& progress) {
  if (Expected<void> known = check_names("mode", options.modes, kTearModes); !known) return fail(known.error());
  if (Expected<void> known = check_names("way", options.ways, kWays); !known) return fail(known.error());
  for (const int nodes : options.nodes)  // before minutes have been spent on the others
    if (const Expected<StudyPlate> plate = make_study_plate(nodes); !plate) return fail(plate.error());

  if (!(options.seconds_per_case >= 0.0) || !std::isfinite(options.seconds_per_case))
    return fail(fmt::format("{} seconds a plate", options.seconds_per_case), "0 or more");
  const bool dense_alone = options.ways.size() == 1 && options.ways.front() == kWays.front();
  if (dense_alone && *std::min_element(options.nodes.begin(), options.nodes.end()) > kDenseNodes)
    return fail("'dense-inverse' holds the whole inverse, and none of the plates is small enough",
                fmt::format("--nodes of up to {}", kDenseNodes));

  ordered_json rows = ordered_json::array();
  Advancement advancement(options.nodes, options.modes.size());
  bool goes_on = true;
  for (const int nodes : options.nodes) {
    const Expected<StudyPlate> plate = make_study_plate(nodes);
    for (std::size_t m = 0; m < kTearModes.size() && goes_on; ++m) {
      if (std::find(options.modes.begin(), options.modes.end(), kTearModes[m]) == options.modes.end()) continue;
      RestructuringCase one(*plate, static_cast<TearMode>(m), options.ways);
      const Stopwatch watch;
      for (int round = 0; round < kMostRounds && goes_on; ++round) {
        const auto told = [&](double of_round) {
          const double by_rounds = (round + of_round) / one.least_rounds();
          const double part = std::min({1.0, by_rounds, watch.seconds() / options.seconds_per_case});
          return progress(advancement.fraction(nodes, part),
                          fmt::format("{} nodes, {}, round {}", nodes, kTearModes[m], round + 1));
        };
        const Expected<bool> done = one.run_round(told);
        if (!done) return fail(done.error());
        goes_on = *done;
        if (round + 1 >= one.least_rounds() && watch.seconds() > options.seconds_per_case) break;
      }
      for (ordered_json& row : one.rows(nodes)) rows.push_back(std::move(row));
      advancement.finish(nodes);
      if (rows.empty()) continue;
      if (Expected<void> done = folder.write_table("restructuring", rows); !done) return fail(done.error());
      if (Expected<void> done = folder.write_figure("restructuring", restructuring_chart(rows)); !done)
        return fail(done.error());
    }
  }
  beside_the_thesis(folder, rows);
  if (rows.empty()) return fail("nothing was measured", "another --way, or smaller plates for 'dense-inverse'");
  return rows;
}

}  // namespace rhexis::studies
