#include "studies/reaction_error.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <mutex>
#include <optional>

#include <fmt/format.h>

#include "base/parallel.h"
#include "studies/published.h"
#include "studies/reaction_error_figures.h"
#include "studies/reaction_tally.h"
#include "studies/study_plate.h"

namespace rhexis::studies {
namespace {

using nlohmann::ordered_json;
using record::build::FactoredState;
using record::build::Recorder;

constexpr double kHalfTurn = 180.0;

/// The body, with all that is the same for every cell.
struct Case {
  StudyPlate plate;
  std::unique_ptr<const Recorder> recorder;
  std::unique_ptr<const FactoredState> first;
  ReactionBody body;
  std::vector<Vec3> points;  ///< m, of the grasp points
  std::vector<Vec3> pulls;   ///< m

  static Expected<std::unique_ptr<const Case>> make(int nodes);
};

Expected<std::unique_ptr<const Case>> Case::make(int nodes) {
  auto out = std::make_unique<Case>();
  Expected<StudyPlate> plate = make_study_plate(nodes);
  if (!plate) return fail(std::move(plate.error()));
  out->plate = std::move(*plate);
  const fracture::CrackLine& crack = out->plate.cracks.front().line;
  Expected<record::build::TornState> torn =
      record::build::TornState::begin(out->plate.mesh, out->plate.settings.body, crack);
  if (!torn) return fail(std::move(torn.error()));
  out->recorder = std::make_unique<const Recorder>(out->plate.mesh, out->plate.settings.body, false);
  FactoredState first{std::move(*torn), record::build::OperatorFactor(out->recorder->layout())};
  if (!out->recorder->factor(first)) return fail("the cracked plate is not stable");
  out->first = std::make_unique<const FactoredState>(std::move(first));
  const record::store::Frame frame = record::build::frame_of(crack);
  out->body = {&out->plate.mesh, frame, record::store::Parameters{}.lengths.front(), out->recorder.get(),
               out->first.get()};
  for (const std::int32_t node : out->recorder->points())
    out->points.push_back(out->plate.mesh.nodes[static_cast<std::size_t>(node)]);
  out->pulls = recorded_pulls(frame);
  return std::unique_ptr<const Case>(std::move(out));
}

bool divides_half_turn(double degrees) {
  const double parts = kHalfTurn / degrees;
  return degrees > 0.0 && std::isfinite(parts) && std::abs(parts - std::round(parts)) < 1e-9;
}

/// 180 angles, as the thesis has them: step, 2 step, ..., 180.
std::vector<double> angles_in(double low, double high, int step) {
  std::vector<double> out;
  for (int angle = step; angle <= static_cast<int>(kHalfTurn); angle += step) {
    if (angle > low && angle <= high) out.push_back(angle);
  }
  return out;
}

std::vector<ReactionCell> make_cells(int advances, double spacing, int step) {
  const int parts = static_cast<int>(std::lround(kHalfTurn / spacing));
  std::vector<ReactionCell> out{{}};
  for (int advance = 0; advance < advances; ++advance) {
    std::vector<ReactionCell> longer;
    for (const ReactionCell& cell : out) {
      for (int k = 0; k < parts; ++k) {
        ReactionCell next = cell;
        next.low.push_back(spacing * k);
        next.high.push_back(spacing * (k + 1));
        next.inside.push_back(angles_in(next.low.back(), next.high.back(), step));
        if (!next.inside.back().empty()) longer.push_back(std::move(next));
      }
    }
    out = std::move(longer);
  }
  return out;
}

/// What is to be done in all, in torn bodies solved.
double cost_of(const ReactionCell& cell) {
  double inside = 1.0;
  for (const std::vector<double>& angles : cell.inside) inside *= static_cast<double>(angles.size());
  return inside + 10.0 * std::pow(2.0, static_cast<double>(cell.low.size()));
}
double cost_of(const std::vector<ReactionCell>& cells) {
  double sum = 0.0;
  for (const ReactionCell& cell : cells) sum += cost_of(cell);
  return sum;
}

/// Tells of what is done, from any thread, one call at a time.
class Advancement {
 public:
  Advancement(double all, const Progress& progress) : all_(all), progress_(progress) {}
  void done(double cost, std::string_view what) {
    const std::lock_guard lock(mutex_);
    done_ += cost;
    if (progress_ && !stopped_ && !progress_(std::min(1.0, done_ / all_), what)) stopped_ = true;
  }
  [[nodiscard]] bool stopped() const { return stopped_; }

 private:
  double all_;
  const Progress& progress_;
  std::mutex mutex_;
  double done_ = 0.0;
  std::atomic<bool> stopped_ = false;
};

/// Empty: stopped.
std::optional<ReactionTally> tally_of(const Case& of, const std::vector<ReactionCell>& cells, std::string_view what,
                                      Advancement& advancement, ForceCurve* curve) {
  std::vector<ReactionTally> tallies(cells.size());
  std::vector<ForceCurve> curves(cells.size());
  parallel_for(cells.size(), [&](std::size_t k) {
    if (advancement.stopped()) return;
    visit_cell(of.body, cells[k], [&](const ReactionQuery& query) {
      count_errors(query, of.pulls, of.points, of.body.frame, tallies[k]);
      if (curve != nullptr) curves[k].add(query, *curve);
    });
    advancement.done(cost_of(cells[k]), what);
  });
  if (advancement.stopped()) return std::nullopt;
  // In the order of the cells, whoever had them.
  ReactionTally out;
  for (const ReactionTally& one : tallies) out.merge(one);
  for (const ForceCurve& one : curves) {
    if (curve != nullptr) curve->append(one);
  }
  return out;
}

void add_rows(ordered_json& rows, int advances, const ReactionTally& tally) {
  const double scale = std::max(tally.all[0].error.largest, tally.all[1].error.largest);
  const auto thesis = [&](std::string_view what) {
    return published_value(fmt::format("reaction-error.{}.{}", what, advances));
  };
  for (std::size_t k = 0; k < kReactionWays.size(); ++k) {
    const WayTally& way = tally.all[k];
    const auto count = static_cast<double>(way.error.count);
    ordered_json row{{"advances", advances},
                     {"way", kReactionWays[k]},
                     {"patterns", way.error.count},
                     {"torn_off", tally.torn_off},
                     {"better", k == 0 ? ordered_json() : ordered_json(static_cast<double>(way.better) / count)},
                     {"tied", k == 0 ? ordered_json() : ordered_json(static_cast<double>(way.tied) / count)},
                     {"better_untied",
                      k == 0 ? ordered_json()
                             : ordered_json(static_cast<double>(way.better) / (count - static_cast<double>(way.tied)))},
                     {"mean", way.error.mean() / scale},
                     {"deviation", way.error.deviation() / scale},
                     {"mean_N", way.error.mean()},
                     {"deviation_N", way.error.deviation()},
                     {"largest_N", way.error.largest},
                     {"mean_relative", way.relative.mean()},
                     {"deviation_relative", way.relative.deviation()},
                     {"thesis_better", k == 1 ? ordered_json(thesis("better") / 100.0) : ordered_json()},
                     {"thesis_mean", ordered_json()},
                     {"thesis_deviation", ordered_json()}};
    if (k < 2) row["thesis_mean"] = thesis(k == 0 ? "mean-without" : "mean-with");
    if (k < 2) row["thesis_deviation"] = thesis(k == 0 ? "deviation-without" : "deviation-with");
    rows.push_back(std::move(row));
  }
}

/// Tables 5.9 and 5.10 beside ours.
void beside_the_thesis(const StudyFolder& folder, const ordered_json& rows) {
  const std::string plate =
      "Our plate's mesh is another, and its exact force jumps every few degrees with the tets that are taken away, "
      "which weights linear in the angle cannot follow.";
  for (const ordered_json& row : rows) {
    const auto compare = [&](std::string_view what, const ordered_json& ours, const std::string& why) {
      folder.compare(fmt::format("reaction-error.{}.{}", what, row.at("advances").get<int>()), ours, why);
    };
    if (row.at("way") == kReactionWays[0]) {
      compare("patterns", row.at("patterns"), "Fewer or more grasp points, and without those that have come off.");
      compare("mean-without", row.at("mean"),
              "What the thesis divides by is not said; ours by the largest error of its two ways.");
      compare("deviation-without", row.at("deviation"), "The same.");
    } else if (row.at("way") == kReactionWays[1]) {
      compare("better", 100.0 * row.at("better").get<double>(), plate);
      compare("mean-with", row.at("mean"), plate);
      compare("deviation-with", row.at("deviation"), plate);
    }
  }
}

/// The means of every way in N and of the exact force, one row a key.
ordered_json means_of(ordered_json row, const Ways& ways) {
  for (std::size_t k = 0; k < kReactionWays.size(); ++k) {
    row[fmt::format("{}_N", kReactionWays[k])] = ways[k].error.mean();
    row[fmt::format("{}_relative", kReactionWays[k])] = ways[k].relative.mean();
  }
  return row;
}

Expected<void> check(const ReactionErrorOptions& options) {
  for (const int advances : options.advances) {
    if (advances < 1 || advances > 2) return fail(fmt::format("{} advances", advances), "1 or 2");
  }
  if (options.advances.empty() && options.spacings.empty()) return fail("nothing to do", "--advances 1");
  std::vector<double> spacings = options.spacings;
  spacings.push_back(options.spacing);
  for (const double spacing : spacings) {
    if (!divides_half_turn(spacing) || spacing < 1.0)
      return fail(fmt::format("recorded every {} degrees", spacing), "1 or more, that divides 180");
  }
  if (options.step < 1 || !divides_half_turn(options.step))
    return fail(fmt::format("asked for every {} degrees", options.step), "a whole number that divides 180");
  return {};
}

}  // namespace

Expected<ordered_json> run_reaction_error(const ReactionErrorOptions& options, const StudyFolder& folder,
                                          const Progress& progress) {
  if (Expected<void> fine = check(options); !fine) return fail(fine.error());
  const Expected<std::unique_ptr<const Case>> made = Case::make(options.nodes);
  if (!made) return fail(made.error());
  const Case& of = **made;
  std::vector<double> spacings = options.spacings;
  std::sort(spacings.begin(), spacings.end());
  double all = 0.0;
  for (const int advances : options.advances) all += cost_of(make_cells(advances, options.spacing, options.step));
  for (const double spacing : spacings) all += cost_of(make_cells(1, spacing, options.step));
  Advancement advancement(all, progress);

  ordered_json spacing_rows = ordered_json::array();
  for (const double spacing : spacings) {
    const std::optional<ReactionTally> tally =
        tally_of(of, make_cells(1, spacing, options.step), fmt::format("recorded every {} degrees", spacing),
                 advancement, nullptr);
    if (!tally) return fail("stopped before the first table was whole");
    spacing_rows.push_back(means_of({{"spacing", spacing}}, tally->all));
  }
  if (!spacing_rows.empty()) {
    if (Expected<void> done = folder.write_table("reaction-error-spacing", spacing_rows); !done)
      return fail(done.error());
    if (Expected<void> done = folder.write_figure("reaction-error-spacing", spacing_chart(spacing_rows)); !done)
      return fail(done.error());
  }

  folder.note(
      "The plate of the thesis runs on by one or two advances of 40.3 mm in every direction; the forces of every free "
      "node of its surface under 36 pulls of 120 mm, from a record of every 15 degrees, against those of the torn body "
      "factored anew. nearest and linear are the thesis's, without and with its correction; local solves the "
      "surroundings of the crack as they are and takes the far field from the same record.");
  ordered_json rows = ordered_json::array();
  ordered_json distance_rows = ordered_json::array();
  for (const int advances : options.advances) {
    ForceCurve curve(of.points, of.plate.at, of.plate.by);
    const std::optional<ReactionTally> tally = tally_of(of, make_cells(advances, options.spacing, options.step),
                                                        fmt::format("{} advance{}", advances, advances == 1 ? "" : "s"),
                                                        advancement, advances == 1 ? &curve : nullptr);
    if (!tally) break;
    add_rows(rows, advances, *tally);
    for (const auto& [distance, ways] : tally->distance)
      distance_rows.push_back(
          means_of({{"advances", advances}, {"distance_mm", 1e3 * kDistanceClass * (distance + 0.5)}}, ways));
    std::vector<std::pair<std::string, ordered_json>> tables{{"reaction-error", rows},
                                                             {"reaction-error-distance", distance_rows}};
    std::vector<std::pair<std::string, result::Chart>> figures{
        {"reaction-error-distance", distance_chart(distance_rows)}};
    if (advances == 1) {
      ordered_json angle_rows = ordered_json::array();
      for (const auto& [angle, ways] : tally->angle) angle_rows.push_back(means_of({{"angle", angle}}, ways));
      tables.emplace_back("reaction-error-angle", angle_rows);
      figures.emplace_back("reaction-error-angle", angle_chart(angle_rows, options.spacing));
      tables.emplace_back("reaction-error-force", curve.rows());
      figures.emplace_back("reaction-error-force", force_chart(curve.rows(), options.spacing));
    }
    for (const auto& [name, table] : tables)
      if (Expected<void> done = folder.write_table(name, table); !done) return fail(done.error());
    for (const auto& [name, figure] : figures)
      if (Expected<void> done = folder.write_figure(name, figure); !done) return fail(done.error());
  }
  if (rows.empty() && !options.advances.empty()) return fail("stopped before the first table was whole");
  beside_the_thesis(folder, rows);
  return rows.empty() ? spacing_rows : rows;
}

}  // namespace rhexis::studies
