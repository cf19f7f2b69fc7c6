#include "haptics/tick.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"

namespace rhexis::haptics {
namespace {

using response::ForceSnapshot;

constexpr double kNone = std::numeric_limits<double>::infinity();

/// Of the trend, the part that a new value has: over some ten ticks it shows whether motions go on or turn back.
constexpr double kTrendSmoothing = 0.1;

double smaller_limit(double one, double other) {
  return std::min(one > 0.0 ? one : kNone, other > 0.0 ? other : kNone);
}

bool is_finite(const ForceSnapshot& snapshot) {
  double sum = snapshot.force_limit;  // one that is not finite makes the sum so
  for (const double value : snapshot.stiffness) sum += value;
  for (std::size_t i = 0; i < 3; ++i) sum += snapshot.rest[i] + snapshot.start[i] + snapshot.normal[i];
  return std::isfinite(sum);
}

std::array<double, 3> array_of(const Vec3& value) { return {value[0], value[1], value[2]}; }

/// The largest part in [0, 1] of `more` with |force + part more| <= limit, where |force| <= limit.
double part_within(const Vec3& force, const Vec3& more, double limit) {
  if ((force + more).norm() <= limit) return 1.0;
  const double a = more.squaredNorm();
  if (a <= 0.0) return 1.0;
  const double b = force.dot(more);
  const double c = std::min(0.0, force.squaredNorm() - limit * limit);
  return std::clamp((-b + std::sqrt(std::max(0.0, b * b - a * c))) / a, 0.0, 1.0);
}

}  // namespace

HapticTick::HapticTick(const TickSettings& settings, const DeviceTraits& traits)
    : settings_(settings),
      device_limit_(smaller_limit(settings.max_force, traits.max_force)),
      counts_from_hold_(traits.counts_from_hold),
      delay_(static_cast<std::uint64_t>(std::clamp(traits.delay, 0, kMostDelay))),
      smoothing_(smoothing_of(settings.velocity_cutoff)),
      filter_(traits.resolution),
      ledger_(settings.reserve, settings.restrains) {
  const Expected<void> good = check_settings(settings);
  RHEXIS_CHECK(good, "{}", good.error().message());
  written_.fill(Vec3::Zero());
}

TickOutput HapticTick::step(const Reading& reading, const ForceSnapshot& law, bool fresh) noexcept {
  if (law_age_ < std::numeric_limits<std::uint32_t>::max()) ++law_age_;
  if (fresh) take_up(law);
  const bool is_there = reading.present && reading.position.allFinite();
  if (is_there) follow_device(reading.position);
  was_there_ = is_there;

  close_grip();
  change_phase(is_there);
  if (fresh) follow_law();
  move_presence(is_there && newest_is_readable_);
  find_force();

  TickOutput out;
  out.force = force_;
  out.hand = hand_state(reading);
  out.law_age = law_age_;
  out.given = ledger_.given();
  out.balance = ledger_.balance();
  out.gain = settings_.is_rigid() ? presence_ : ledger_.gain();
  written_[tick_ % written_.size()] = force_;
  ++tick_;
  return out;
}

void HapticTick::take_up(const ForceSnapshot& snapshot) noexcept {
  law_age_ = 0;
  number_ = snapshot.number;
  newest_is_readable_ = is_finite(snapshot);
  if (newest_is_readable_) newest_ = snapshot;
}

void HapticTick::follow_device(const Vec3& position) noexcept {
  // After a gap the hold goes on from where it was: nobody knows how the device came where it is.
  if (!was_there_ && position_ && !counts_from_hold_) zero_ += position - *position_;
  const Vec3 seen = was_there_ ? filter_.follow(position) : filter_.restart(position);
  const Vec3 moved = was_there_ ? Vec3(seen - *seen_) : Vec3(Vec3::Zero());
  if (!was_there_) velocity_.setZero();
  trend_ += kTrendSmoothing * (velocity_.dot(moved) - trend_);
  velocity_ += smoothing_ * (moved / kTickSeconds - velocity_);
  position_ = position;
  seen_ = seen;
  if (phase_ == Phase::idle) return;
  at_ = position - zero_;
  aside_ = seen - position;
  const double before = stored_;
  evaluate();
  ledger_.moved(acting_force().dot(moved), before, stored_);
}

void HapticTick::evaluate() noexcept {
  coupled_ = couple(law_, at_, settings_.stiffness, limit_);
  stored_ = aside_.isZero(0.0) ? coupled_.energy : couple(law_, at_ + aside_, settings_.stiffness, limit_).energy;
}

/// N, on the hand, between the last tick and this one.
Vec3 HapticTick::acting_force() const noexcept {
  return tick_ > delay_ ? written_[(tick_ - 1 - delay_) % written_.size()] : Vec3(Vec3::Zero());
}

bool HapticTick::is_held_by(std::uint32_t grasp) const noexcept {
  const bool is_held = (newest_.flags & ForceSnapshot::is_held) != 0 && (newest_.flags & ForceSnapshot::torn_off) == 0;
  return is_held && newest_.grasp == grasp;
}

void HapticTick::change_phase(bool device_is_there) noexcept {
  if (phase_ == Phase::holding && !is_held_by(grasp_)) phase_ = Phase::releasing;
  // A device that feels nothing need not wait until the last hold has faded.
  if (phase_ == Phase::releasing && (presence_ <= 0.0 || settings_.is_rigid())) phase_ = Phase::idle;
  if (phase_ == Phase::idle && device_is_there && newest_is_readable_ && is_held_by(newest_.grasp)) take_hold();
}

void HapticTick::take_hold() noexcept {
  phase_ = Phase::holding;
  grasp_ = newest_.grasp;
  held_ticks_ = 0;
  zero_ = counts_from_hold_ ? Vec3(Vec3::Zero()) : *position_;
  at_ = *position_ - zero_;
  velocity_.setZero();
  force_.setZero();
  law_ = newest_law();
  limit_ = limit_now();
  aside_ = *seen_ - *position_;
  evaluate();
  ledger_.restart();
  ledger_.move_gain(1.0, 1.0, stored_);
  presence_ = settings_.is_rigid() ? 0.0 : 1.0;
}

FeltLaw HapticTick::newest_law() const noexcept {
  using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  const Eigen::Map<const RowMajor> stiffness(newest_.stiffness.data());
  const Eigen::Map<const Vec3> rest(newest_.rest.data());
  const Eigen::Map<const Vec3> start(newest_.start.data());
  const Eigen::Map<const Vec3> normal(newest_.normal.data());
  return FeltLaw::make(settings_.motion_scale * settings_.force_scale * stiffness,
                       (rest - start) / settings_.motion_scale, normal,
                       (newest_.flags & ForceSnapshot::pushes_only) != 0);
}

/// The grip closes in ramp_ticks, and slips until then where more is asked of it.
double HapticTick::limit_now() const noexcept {
  if (settings_.is_rigid()) return kNone;
  const double full = smaller_limit(device_limit_, newest_.force_limit);
  return full * static_cast<double>(held_ticks_) / settings_.ramp_ticks;
}

void HapticTick::follow_law() noexcept {
  if (phase_ != Phase::holding || !newest_is_readable_) return;
  law_ = newest_law();
  limit_ = limit_now();
  const double before = stored_;
  evaluate();
  ledger_.law_changed(before, stored_);
}

/// What the spring would have to stretch further for is let slip: the hand stays, the device's zero comes after it. The
/// energy of that stretch is lost, so that closing a grip around a moving hand gives none out.
void HapticTick::close_grip() noexcept {
  if (phase_ != Phase::holding || held_ticks_ >= settings_.ramp_ticks) return;
  if (coupled_.limited && was_there_) {
    const Vec3 reached = coupled_.hand + coupled_.force / settings_.stiffness;
    zero_ += at_ - reached;
    at_ = reached;
    const double before = stored_;
    evaluate();
    ledger_.slipped(before - stored_);
  }
  ++held_ticks_;
  limit_ = limit_now();  // nothing that is read is stretched beyond it, so that the force stays
  const double before = stored_;
  evaluate();
  ledger_.law_changed(before, stored_);
}

double HapticTick::fading() const noexcept {
  return std::clamp(
      (settings_.lost_ticks - static_cast<double>(law_age_)) / (settings_.lost_ticks - settings_.late_ticks), 0.0, 1.0);
}

void HapticTick::move_presence(bool nothing_is_wrong) noexcept {
  const double step = 1.0 / settings_.ramp_ticks;
  if (!nothing_is_wrong || phase_ == Phase::idle)
    presence_ = 0.0;
  else if (phase_ == Phase::releasing)
    presence_ = std::min(fading(), presence_ - step);
  else
    presence_ = std::min(fading(), presence_ + step);
  presence_ = std::max(0.0, presence_);
  ledger_.move_gain(presence_, step, stored_);
}

Vec3 HapticTick::damping_force() const noexcept {
  Vec3 damping = Vec3::Zero();
  if (trend_ < 0.0) return damping;  // a position that jumps to and fro would be pushed on by it
  if (!coupled_.force.isZero(0.0))
    damping = -presence_ * settings_.damping * (felt_part(law_, settings_.stiffness) * velocity_);
  const double squared = velocity_.squaredNorm();
  if (settings_.restrains && ledger_.missing() > 0.0 && squared > 0.0)
    damping -= std::min(ledger_.missing() / (kTickSeconds * squared), settings_.most_restraint) * velocity_;
  return damping;
}

void HapticTick::find_force() noexcept {
  force_.setZero();
  is_clipped_ = coupled_.limited;
  if (presence_ <= 0.0) return;
  if (settings_.is_rigid()) {
    force_ = -presence_ * coupled_.force;
    const double limit = smaller_limit(device_limit_, newest_.force_limit);
    is_clipped_ = force_.norm() > limit;
    if (is_clipped_) force_ *= limit / force_.norm();
    return;
  }
  const double most = trend_ < 0.0 ? 0.0 : settings_.most_restraint;
  ledger_.settle(most * kTickSeconds * velocity_.squaredNorm(), stored_);
  const Vec3 elastic = -ledger_.gain() * coupled_.force;
  const Vec3 damping = damping_force();
  double part = part_within(elastic, damping, limit_);
  const double outward = elastic.dot(law_.normal);
  const double inward = -damping.dot(law_.normal);
  if (law_.pushes_only && inward > 0.0) part = std::min(part, std::max(0.0, outward) / inward);  // it cannot stick
  force_ = elastic + part * damping;
  if (!force_.allFinite()) force_.setZero();
}

HandState HapticTick::hand_state(const Reading& reading) const noexcept {
  HandState out;
  out.tick = tick_;
  out.number = number_;
  out.grasp = grasp_;
  out.hand = array_of(settings_.motion_scale * coupled_.hand);
  out.device = array_of(settings_.motion_scale * at_);
  out.force = array_of(force_);
  const auto raise = [&](HandState::Flag flag, bool when) {
    out.flags |= when ? static_cast<std::uint32_t>(flag) : 0u;
  };
  raise(HandState::present, reading.present);
  raise(HandState::in_trouble, (reading.present && !was_there_) || (number_ > 0 && !newest_is_readable_));
  if (phase_ == Phase::idle) return out;
  out.body_force = array_of(-coupled_.force / settings_.force_scale);
  raise(HandState::holds, phase_ == Phase::holding);
  raise(HandState::in_contact, !coupled_.force.isZero(0.0));
  raise(HandState::limited, is_clipped_);
  raise(HandState::faded, fading() < 1.0);
  raise(HandState::lost, fading() <= 0.0);
  raise(HandState::restrained,
        !settings_.is_rigid() && settings_.restrains && (ledger_.missing() > 0.0 || ledger_.gain() < presence_));
  return out;
}

}  // namespace rhexis::haptics
