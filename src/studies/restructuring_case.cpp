#include "studies/restructuring_case.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

#include <fmt/format.h>

#include "base/clock.h"
#include "base/parallel.h"
#include "fracture/local_object.h"
#include "record/build/campaign.h"
#include "studies/full_solve.h"

namespace rhexis::studies {
namespace {

using nlohmann::ordered_json;

/// Advances that a plate is torn on by before the other ways follow: as many as come one upon the other in a slow pull,
/// so that the background has no more time than it has there.
constexpr std::size_t kBlock = 8;
/// s: a way that takes longer than this follows a slow pull at every so many-th advance only.
constexpr double kPatience = 0.5;

/// Of some values, which are there.
struct Spread {
  explicit Spread(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    for (const double value : values) mean += value / static_cast<double>(values.size());
    const std::size_t half = values.size() / 2;
    median = values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
    least = values.front();
    most = values.back();
  }
  double mean = 0.0, median = 0.0, least = 0.0, most = 0.0;
};

}  // namespace

/// The torn body of each advance once more, beside the session, for the ways that start from it alone.
class RestructuringCase::Follower {
 public:
  explicit Follower(const StudyPlate& plate)
      : elastic_(plate.settings.body), body_(plate.mesh), surroundings_(plate.mesh) {}

  /// Takes the edit of a session, of the same plate.
  void take(const mesh::MeshEdit& edit) {
    body_.apply(edit);
    surroundings_.follow(edit, body_);
  }
  [[nodiscard]] std::optional<FullSolveSeconds> sparse() const { return time_sparse_factor(body_, elastic_); }
  [[nodiscard]] std::optional<FullSolveSeconds> dense() const { return time_dense_inverse(body_, elastic_); }

  /// s, of finding the tets of the local object after an advance, and factoring it; empty: it is not stable.
  [[nodiscard]] std::optional<double> local_object(const session::AdvanceRecord& after, double radius,
                                                   std::span<const NodeId> hand) const {
    fracture::Crack crack;
    for (const Vec3& at : after.front_after) crack.front.push_back({.position = at});
    std::vector<std::uint8_t> supported(body_.mesh().node_count(), 0);
    for (const model::PrescribedDof& support : elastic_.supports)
      supported[static_cast<std::size_t>(support.dof / 3)] = 1;
    const Stopwatch watch;
    fracture::LocalObject local(body_, elastic_.elastic, surroundings_.tets_near(body_, crack, radius), supported,
                                hand);
    if (!local.factor()) return std::nullopt;
    return watch.seconds();
  }

 private:
  const response::ElasticBody& elastic_;
  mesh::TornMesh body_;
  fracture::Surroundings surroundings_;
};

bool RestructuringCase::wants(std::string_view way) const {
  return std::find(ways_.begin(), ways_.end(), way) != ways_.end();
}

bool RestructuringCase::is_due(std::string_view way, std::size_t advance) const {
  const auto done = done_.find(way);
  if (done == done_.end() || done->second.back().round != round_ || mode_ == TearMode::imposed) return true;
  const Restructured& last = done->second.back();
  return static_cast<double>(advance - last.advance) * kPatience >= last.seconds;
}

void RestructuringCase::keep(std::string_view way, Restructured what) {
  what.round = round_;
  done_[std::string(way)].push_back(what);
}

void RestructuringCase::keep_exact(std::string_view way, const TornOn& torn, std::size_t from) {
  if (!wants(way)) return;
  for (std::size_t advance = from; advance < torn.advances().size(); ++advance) {
    const auto& [record, seconds] = torn.advances()[advance];
    keep(way, {.advance = advance,
               .tets = record.tets_removed,
               .length = record.length,
               .seconds = seconds,
               .remesh = record.remesh_seconds,
               .local = record.local_seconds,
               .update = record.update_seconds,
               .wait = record.wait_seconds});
  }
}

Expected<void> RestructuringCase::follow(Follower& follower, const TornOn& torn, std::size_t advance) {
  const session::AdvanceRecord& record = torn.advances()[advance].record;
  Restructured what{.advance = advance, .tets = record.tets_removed, .length = record.length};
  const auto unstable = [&] {
    return fail(
        fmt::format("the plate of {} nodes is not stable after advance {}", plate_.mesh.node_count(), advance + 1));
  };
  if (wants("local") && !record.finished) {
    const std::optional<double> local = follower.local_object(record, torn.local_radius(record), torn.hand_nodes());
    if (!local) return unstable();
    what.remesh = record.remesh_seconds;
    what.local = *local;
    what.seconds = what.remesh + what.local;
    keep("local", what);
    what.remesh = what.local = Restructured::kNone;
  }
  for (const std::string_view way : {"sparse", "dense-inverse"}) {
    const bool dense = way == "dense-inverse";
    if (!wants(way) || !is_due(way, advance)) continue;
    if (dense && plate_.mesh.node_count() > static_cast<std::size_t>(kDenseNodes)) continue;
    const std::optional<FullSolveSeconds> full = dense ? follower.dense() : follower.sparse();
    if (!full) return unstable();
    what.assembly = full->assembly;
    what.analysis = dense ? Restructured::kNone : full->analysis;
    what.factor = full->factor;
    what.seconds = full->total();
    keep(way, what);
  }
  return {};
}

namespace {

/// Straight on and to both sides, by the two advances of the thesis: what is looked up does not depend on how many
/// directions there are.
Expected<response::SharedRecord> make_record(const StudyPlate& plate) {
  record::build::CampaignRequest request;
  request.mesh = plate.mesh;
  request.elastic = plate.settings.body;
  request.crack = plate.cracks.front().line;
  request.parameters.directions = 3;
  request.parameters.advances = kImposedAdvances;
  request.parameters.lengths = {kImposedLength};
  const Expected<record::build::Campaign> campaign = record::build::Campaign::plan(std::move(request));
  if (!campaign) return fail(campaign.error());
  const std::filesystem::path file = std::filesystem::temp_directory_path() /
                                     fmt::format("rhexis-restructuring-{}-{}.h5", ::getpid(), plate.mesh.node_count());
  const Expected<record::build::CampaignReport> made = campaign->run(file, {}, nullptr);
  if (!made) return fail(made.error());
  Expected<response::SharedRecord> read = record::store::LoadedRecord::read(file);
  std::error_code code;
  std::filesystem::remove(file, code);
  return read;
}

}  // namespace

Expected<void> RestructuringCase::tear_recorded() {
  if (!record_) {
    Expected<response::SharedRecord> made = make_record(plate_);
    if (!made) return fail(std::move(made.error()));
    record_ = std::move(*made);
  }
  StudyPlate plate = plate_;
  plate.settings.record = record_;
  Expected<TornOn> torn = TornOn::start(plate, mode_, false);
  if (!torn) return fail(std::move(torn.error()));
  while (!torn->at_end()) torn->tear_on(kBlock);
  keep_exact("recorded", *torn, 0);
  return {};
}

Expected<bool> RestructuringCase::run_round(const std::function<bool(double)>& told) {
  // Both exact ways take turns, when both are wanted.
  ++round_;
  const bool all_work = wants("exact") && wants("exact-all-work") ? round_ % 2 == 1 : wants("exact-all-work");
  const std::string_view exact = all_work ? "exact-all-work" : "exact";
  Expected<TornOn> torn = TornOn::start(plate_, mode_, !all_work);
  if (!torn) return fail(std::move(torn.error()));
  Follower follower(plate_);
  follower.take(torn->body().history().front());
  while (!torn->at_end()) {
    const std::size_t from = torn->advances().size();
    torn->tear_on(kBlock);
    keep_exact(exact, *torn, from);
    for (std::size_t advance = from; advance < torn->advances().size(); ++advance) {
      follower.take(torn->body().history()[advance + 1]);
      if (Expected<void> done = follow(follower, *torn, advance); !done) return fail(std::move(done.error()));
    }
    if (!told(torn->part_done())) return false;
  }
  if (wants("recorded") && mode_ == TearMode::imposed &&
      plate_.mesh.node_count() <= static_cast<std::size_t>(kDenseNodes)) {
    if (Expected<void> done = tear_recorded(); !done) return fail(std::move(done.error()));
  }
  return true;
}

double RestructuringCase::sparse_over(std::string_view way) const {
  const auto mean_beside = [&](std::string_view what, std::string_view beside) {
    std::vector<bool> has(static_cast<std::size_t>(round_) + 1, false);
    if (const auto found = done_.find(beside); found != done_.end())
      for (const Restructured& one : found->second) has[static_cast<std::size_t>(one.round)] = true;
    std::vector<double> seconds;
    if (const auto found = done_.find(what); found != done_.end())
      for (const Restructured& one : found->second)
        if (has[static_cast<std::size_t>(one.round)]) seconds.push_back(one.seconds);
    return seconds.empty() ? Restructured::kNone : Spread(seconds).mean;
  };
  return mean_beside("sparse", way) / mean_beside(way, "sparse");
}

std::vector<ordered_json> RestructuringCase::rows(int nodes) const {
  std::vector<ordered_json> out;
  for (const std::string_view way : kWays) {
    const auto found = done_.find(way);
    if (found == done_.end()) continue;
    const std::vector<Restructured>& done = found->second;
    const auto count = static_cast<double>(done.size());
    std::vector<double> ms;
    double tets = 0.0;
    for (const Restructured& one : done) {
      ms.push_back(1e3 * one.seconds);
      tets += one.tets;
    }
    const auto mean = [&](double Restructured::*part) {
      double sum = 0.0;
      for (const Restructured& one : done) sum += one.*part;
      return 1e3 * sum / count;
    };
    const Spread spread(ms);
    out.push_back({{"nodes", nodes},
                   {"mode", kTearModes[static_cast<std::size_t>(mode_)]},
                   {"way", way},
                   {"ms_per_advance", spread.mean},
                   {"ms_per_tet", spread.mean * count / tets},
                   {"advances", done.size()},
                   {"ms_median", spread.median},
                   {"ms_least", spread.least},
                   {"ms_most", spread.most},
                   {"sparse_over_this", sparse_over(way)},
                   {"tets_per_advance", tets / count},
                   {"length_mm", mean(&Restructured::length)},
                   {"remesh_ms", mean(&Restructured::remesh)},
                   {"local_ms", mean(&Restructured::local)},
                   {"update_ms", mean(&Restructured::update)},
                   {"wait_ms", mean(&Restructured::wait)},
                   {"assembly_ms", mean(&Restructured::assembly)},
                   {"analysis_ms", mean(&Restructured::analysis)},
                   {"factor_ms", mean(&Restructured::factor)},
                   {"mesh_nodes", plate_.mesh.node_count()},
                   {"mesh_tets", plate_.mesh.tet_count()},
                   {"threads", thread_count()}});
  }
  return out;
}

}  // namespace rhexis::studies
