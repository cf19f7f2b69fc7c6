// One step, as the method has it: take the hand's motion; follow the script; move the body and let it tear; publish.

#include "session/interaction.h"

#include <algorithm>

#include "base/hash.h"
#include "response/publish.h"
#include "session/scene_record.h"

namespace rhexis::session {
namespace {

std::uint64_t hash_of(const response::ForceSnapshot& law) {
  return Hash().add(std::span<const response::ForceSnapshot>(&law, 1)).value();
}

Vec3 vector_of(const std::array<double, 3>& v) { return {v[0], v[1], v[2]}; }

}  // namespace

Interaction::Interaction(std::unique_ptr<OpenBody> body, ReadScene read_scene, InteractionListener& listener)
    : body_(std::move(body)), read_scene_(std::move(read_scene)), listener_(listener) {}

StepOutcome Interaction::step(const haptics::HandState& hand, bool fresh) {
  ++steps_;
  advances_ = 0;
  const std::uint64_t passed = fresh && hand.tick > now_ ? hand.tick - now_ : 0;
  const bool follows = fresh && hand.grasp == grasps_ && (hand.flags & haptics::HandState::holds) != 0;
  follow_script(passed);
  now_ += passed;
  if (runs()) {
    tear().pass(1e-3 * static_cast<double>(passed));
    const bool stands_still = tearing_ > 0 && tearing_ < kMostAdvancesPerTick;
    if (follows && hand.grasp == grasps_ && tear().hand().holds() && !stands_still) {
      settled_ = settled_ && vector_of(hand.hand) == by_;
      by_ = vector_of(hand.hand);
      tearing_ = 0;
    }
    move_body();
  }
  publish();
  return {.number = steps_,
          .force = tear().hand().force(),
          .topology = tear().body().topology(),
          .fingerprint = body_->fingerprint,
          .law = hash_of(law_),
          .advances = advances_};
}

void Interaction::follow_script(std::uint64_t passed) {
  const std::vector<scene::PullSettings>& pulls = body_->problem.pulls;
  const bool was_on = script_.is_on();
  switch (script_.step(pulls, now_ + passed, passed, runs())) {
    case Script::Does::nothing: break;
    case Script::Does::lets_go: let_go(); break;
    case Script::Does::ends: break;
    case Script::Does::grasps: {
      const scene::PullSettings& pull = pulls[script_.pull()];
      if (!hold(pull.at, pull.push ? response::ContactMode::push : response::ContactMode::hold)) script_.end();
      return;
    }
  }
  if (was_on && !script_.is_on()) listener_.says(wire::Level::info, "the script has come to its end");
}

void Interaction::move_body() {
  if (settled_) return;
  const bool held = tear().hand().holds();
  const TickReport report = tear().tick(
      by_, [this](const AdvanceRecord& advance) { tell_of(advance); }, 1);
  settled_ = report.advances == 0 && report.at_rest;
  tearing_ = report.advances == 0 ? 0 : tearing_ + 1;
  const std::string& trouble = report.trouble.empty() ? report.late : report.trouble;
  if (!trouble.empty() && trouble != last_trouble_) listener_.says(wire::Level::warning, trouble);
  if (!trouble.empty() || settled_) last_trouble_ = trouble;
  if (held && report.let_go) {
    torn_off_ = true;
    script_.end();
    listener_.says(wire::Level::warning, "the hand has let go: what it held has come off, or lost its support");
  }
}

void Interaction::tell_of(const AdvanceRecord& advance) {
  ++advances_;
  const mesh::MeshEdit& edit = tear().body().history().back();
  const SurfaceChange change = body_->surface.follow(tear().body(), edit);
  body_->fingerprint = chained(body_->fingerprint, edit, /*taken_back=*/false);
  body_->advance_time.push_back(1e-3 * static_cast<double>(now_));
  listener_.has_torn(advance, change);
  const std::vector<AdvanceRecord>& all = tear().advances();
  const int before = all.size() > 1 ? all[all.size() - 2].pieces : 1;
  if (advance.pieces > before)
    listener_.says(wire::Level::warning, fmt::format("the body is in {} pieces", advance.pieces));
  if (advance.tets_frozen > 0)
    listener_.says(wire::Level::info, "a piece has no support any more: it stays where it was, and cannot be held");
  watch_record();
  if (compares_ && !tear().compared_force()) {
    compares_ = false;
    listener_.says(wire::Level::warning, "the exact response has no answer: a part of the torn body can move freely");
  }
}

/// What the record does not know is said once for a body.
void Interaction::watch_record() {
  const std::optional<response::RecordUse> use = tear().record_use();
  if (!use) return;
  for (const std::string& remark : remarks_on(*use, said_)) listener_.says(wire::Level::warning, remark);
  said_.add(*use);
}

void Interaction::publish() {
  const Hand& hand = tear().hand();
  if (hand.holds()) {
    law_ = response::make_snapshot(hand.law(), {.number = steps_,
                                                .topology = tear().body().topology(),
                                                .grasp = grasps_,
                                                .force_limit = body_->problem.interaction.max_force,
                                                .start = start_});
    return;
  }
  law_ = {};
  law_.number = steps_;
  law_.topology = tear().body().topology();
  law_.grasp = grasps_;
  if (torn_off_) law_.flags |= response::ForceSnapshot::torn_off;
}

bool Interaction::hold(const Vec3& at, response::ContactMode mode) {
  torn_off_ = false;
  by_.setZero();
  settled_ = false;
  tearing_ = 0;
  if (const Expected<void> holds = tear().grasp(at, mode); !holds) {
    say(holds.error());
    return false;
  }
  watch_record();
  ++grasps_;
  start_ = tear().hand().law().rest;
  return true;
}

void Interaction::let_go() {
  tear().let_go();
  torn_off_ = false;
  by_.setZero();
  settled_ = false;
  tearing_ = 0;
}

}  // namespace rhexis::session
