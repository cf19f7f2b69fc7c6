// One tick, as the method has it: take the hand's motion; solve; judge; run the crack on; re-mesh; rebuild the local
// object; update the response; and again, until the stress is below the strength.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "base/check.h"
#include "base/clock.h"
#include "session/tear_session.h"

namespace rhexis::session {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;

/// Of the mean step; zero where the front does not move.
Vec3 direction_of(const fracture::Advance& advance) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& step : advance.step) sum += step;
  return sum.norm() > 0.0 ? Vec3(sum.normalized()) : sum;
}

std::vector<Vec3> positions(const fracture::Crack& crack) {
  std::vector<Vec3> out;
  for (const fracture::FrontPoint& point : crack.front) out.push_back(point.position);
  return out;
}

}  // namespace

TickReport TearSession::tick(const Vec3& hand, const Observer& observer, int most_advances) {
  ++ticks_;
  TickReport report;
  if (hand != hand_at_) round_ = {};
  hand_at_ = hand;
  move_body();
  if (settings_.tears) tear(report, observer, most_advances);
  report.force = hand_.force();
  report.at_rest = moved_.at_rest && !has_torn_;
  report.late = moved_.late;
  return report;
}

void TearSession::move_body() {
  moved_ = hand_.move(hand_at_, *response_);
  has_torn_ = false;
}

void TearSession::tear(TickReport& report, const Observer& observer, int most_advances) {
  solve_local_objects();
  while (report.advances < most_advances && report.trouble.empty()) {
    if (has_torn_ && !is_linear()) {
      move_body();
      solve_local_objects();
    }
    if (!moved_.near) break;  // its stress says nothing yet: the next tick goes on from here
    if (round_.next < cracks_.size()) {
      const std::size_t crack = round_.next++;
      if (const std::optional<Judged> judged = judge(crack))
        round_.tore = run_on(crack, *judged, report, observer) || round_.tore;
      continue;
    }
    if (local_.empty()) round_.tore = start_crack(report, observer);
    if (!std::exchange(round_, {}).tore) break;
  }
  if (!report.trouble.empty()) round_ = {};
}

TickReport TearSession::impose(std::size_t crack, const Vec3& direction, double length, const Observer& observer) {
  RHEXIS_CHECK(crack < cracks_.size() && !cracks_[crack].finished, "crack {} of {}", crack, cracks_.size());
  TickReport report;
  run_on(crack, {.advance = fracture::imposed_advance(cracks_[crack], direction, length, torn_.surroundings())}, report,
         observer);
  report.force = hand_.force();
  return report;
}

std::optional<TearSession::Judged> TearSession::judge(std::size_t crack) const {
  const auto running = std::find(running_.begin(), running_.end(), crack);
  if (running == running_.end()) return std::nullopt;
  const fracture::LocalObject& local = local_[static_cast<std::size_t>(running - running_.begin())];
  const fracture::Crack& front = cracks_[crack];
  std::vector<fracture::Judgement> judgements =
      fracture::judge_front(*criterion_, front, mean_edge(), local.stresses());
  Judged out;
  if (settings_.toughness) {
    const std::vector<double> release = fracture::energy_release(
        body(), front, energies(local), {fracture::kInnerEdges * mean_edge(), fracture::kOuterEdges * mean_edge()},
        body_force_);
    for (std::size_t k = 0; k < judgements.size(); ++k) {
      judgements[k] = fracture::by_toughness(judgements[k], release[k], *settings_.toughness, mean_edge());
      if (std::isfinite(release[k])) out.value = std::max(out.value, release[k]);
    }
  }
  const std::optional<fracture::Advance> advance = fracture::plan_advance(front, judgements, torn_.surroundings());
  if (!advance) return std::nullopt;
  out.advance = *advance;
  if (!settings_.toughness) out.value = advance->value;
  return out;
}

std::vector<fracture::EnergyTet> TearSession::energies(const fracture::LocalObject& local) const {
  if (is_linear()) return fracture::small_strain_energies(settings_.body.elastic, local.tets(), local.gradients());
  std::vector<fracture::EnergyTet> out;
  out.reserve(local.tets().size());
  for (const TetId tet : local.tets()) {
    const response::DeformedTet deformed = response_->deformed(tet);
    out.push_back({tet, deformed.F - Mat3::Identity(), deformed.state.P, deformed.state.W});
  }
  return out;
}

bool TearSession::run_on(std::size_t crack, Judged judged, TickReport& report, const Observer& observer) {
  const Stopwatch watch;
  fracture::Advance& advance = judged.advance;
  Change change;
  change.advance = {.crack = crack, .direction = direction_of(advance), .length = advance.length};
  change.incision = fracture::cut_along(body(), torn_.surroundings(), cracks_[crack], advance,
                                        torn_.incision_settings(hand_.nodes()));
  change.record.length = advance.length;
  change.record.angle = kDegrees * advance.angle;
  change.record.turn = kDegrees * advance.turn;
  change.record.value = judged.value;
  change.record.front_before = positions(cracks_[crack]);
  if (change.incision.edit.empty()) {
    cracks_[crack].finished = true;  // nothing is left to cut: the front has come through
    make_local_objects();
    return false;
  }
  change.next_cracks = [&, crack] {
    std::vector<fracture::Crack> next = cracks_;
    const std::vector<fracture::Crack> fronts =
        fracture::advanced(cracks_[crack], advance, torn_.surroundings(), body());
    next[crack] = fronts.front();
    next.insert(next.end(), fronts.begin() + 1, fronts.end());
    return next;
  };
  change.radius = advance.length;
  change.crack = crack;
  change.seconds = watch.seconds();
  return take(std::move(change), report, observer);
}

bool TearSession::start_crack(TickReport& report, const Observer& observer) {
  if (!settings_.strength || !hand_.holds()) return false;
  const Stopwatch watch;
  VectorX u;
  displacement(surface_basis_, u);
  std::optional<fracture::FirstCut> first = fracture::cut_first(
      body(), surface_stresses(u), *settings_.strength, torn_.surroundings(), torn_.incision_settings(hand_.nodes()));
  if (!first) return false;
  Change change = beginning(std::move(first->start.cracks), std::move(first->incision));
  change.seconds = watch.seconds();
  return take(std::move(change), report, observer);
}

TearSession::Change TearSession::beginning(std::vector<fracture::Crack> cracks, fracture::Incision incision) const {
  Change change;
  change.incision = std::move(incision);
  change.record.started = true;
  change.crack = cracks_.size();
  change.advance = {.crack = change.crack, .started = true};
  change.next_cracks = [this, begun = std::move(cracks)] {
    std::vector<fracture::Crack> next = cracks_;
    next.insert(next.end(), begun.begin(), begun.end());
    return next;
  };
  return change;
}

bool TearSession::take(Change change, TickReport& report, const Observer& observer) {
  Stopwatch watch;
  AdvanceRecord record = std::move(change.record);
  record.force_before = hand_.force();
  const std::vector<fracture::Crack> before = cracks_;
  torn_.apply(std::move(change.incision.edit));
  follow_nodes();
  cracks_ = change.next_cracks();
  record.remesh_seconds = change.seconds + watch.seconds();

  watch.restart();
  const mesh::MeshEdit& edit = body().history().back();
  reach_.resize(cracks_.size(), change.radius);
  reach_[change.crack] = change.radius;
  if (response_) {
    const response::FollowReport followed = response_->follow(edit, foci(), &change.advance);
    record.update_seconds = followed.update_seconds;
    record.wait_seconds = followed.wait_seconds;
    if (!followed.ok) {
      take_back(before);
      report.trouble =
          followed.why.empty()
              ? "the torn body is not stable: a part of it can move freely (hold it by another [[support]])"
              : followed.why;
      return false;
    }
    made_.push_back(change.advance);
    if (comparison_ && !comparison_->follow(edit, foci(), change.advance)) comparison_.reset();
    if (hand_.has_lost_hold(body())) {
      hand_.let_go(*response_);
      report.let_go = true;
    }
    hand_.follow(*response_);
    if (comparison_) comparison_->grasp(hand_);
    record.record = response_->record_use();
  }
  cracks_before_.push_back(before);
  has_torn_ = true;

  watch.restart();
  make_local_objects();
  record.local_seconds = watch.seconds();

  record.topology = body().topology();
  record.tick = ticks_;
  record.edges_cut = change.incision.edges_cut;
  record.tets_removed = static_cast<int>(edit.removed.size());
  record.tets_frozen = static_cast<int>(edit.frozen.size());
  record.nodes_moved = static_cast<int>(edit.moved.size());
  record.nodes_copied = static_cast<int>(edit.copied.size());
  record.volume_lost = change.incision.volume_lost;
  record.pieces = pieces();
  record.finished = cracks_[change.crack].finished;
  record.crack_area = crack_area();
  record.force_after = hand_.force();
  for (std::size_t k = change.crack; k < cracks_.size(); k = std::max(k + 1, before.size())) {
    const std::vector<Vec3> front = positions(cracks_[k]);
    record.front_after.insert(record.front_after.end(), front.begin(), front.end());
  }
  advances_.push_back(std::move(record));
  ++report.advances;
  if (observer) observer(advances_.back());
  return true;
}

}  // namespace rhexis::session
