#include "haptics/emulator_device.h"

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "haptics/tick_settings.h"

namespace rhexis::haptics {
namespace {

/// exp(A) by its series, after A has been halved until it is small, and squared back.
Mat3 exponential(Mat3 a) {
  int halvings = 0;
  for (; a.cwiseAbs().maxCoeff() > 0.125; ++halvings) a *= 0.5;
  Mat3 sum = Mat3::Identity();
  Mat3 term = Mat3::Identity();
  for (int k = 1; k < 16; ++k) {  // 0.375^16 / 16! is below 2^-53 by far
    term = Mat3(term * a) / k;
    sum += term;
  }
  for (; halvings > 0; --halvings) sum = Mat3(sum * sum);
  return sum;
}

}  // namespace

DeviceTraits EmulatorDevice::make_traits(const EmulatorSettings& settings) {
  DeviceTraits traits;
  traits.name = kName;
  traits.what = "an emulated machine in an emulated hand, which feels the force: tests and measurements";
  traits.resolution = settings.resolution;
  traits.max_force = settings.max_force;
  traits.delay = settings.delay;
  traits.follows_script = true;
  return traits;
}

EmulatorDevice::EmulatorDevice(const EmulatorSettings& settings, std::shared_ptr<HandPath> hand)
    : settings_(settings), traits_(make_traits(settings)), hand_(std::move(hand)) {
  Mat3 rate = Mat3::Zero();
  rate(0, 1) = kTickSeconds;
  rate(1, 0) = -kTickSeconds * settings.hand_stiffness / settings.mass;
  rate(1, 1) = -kTickSeconds * (settings.damping + settings.hand_damping) / settings.mass;
  rate(1, 2) = kTickSeconds / settings.mass;
  if (rate.allFinite()) over_tick_ = exponential(rate).topRows<2>();  // else open() refuses
}

Expected<void> EmulatorDevice::open() {
  const EmulatorSettings& s = settings_;
  const auto not_negative = [](double value) { return value >= 0.0 && std::isfinite(value); };
  if (!(s.mass > 0.0) || !std::isfinite(s.mass)) return fail(fmt::format("an emulated mass of {} kg", s.mass), "> 0");
  for (const double value : {s.damping, s.hand_stiffness, s.hand_damping, s.resolution, s.max_force})
    if (!not_negative(value)) return fail(fmt::format("an emulated device with {}", value), "0 or more");
  if (s.delay < 0 || s.delay > kMostDelay)
    return fail(fmt::format("an emulated delay of {} ticks", s.delay), fmt::format("0 to {}", kMostDelay));
  is_open_ = true;
  tick_ = 0;
  hand_at_.setZero();
  hold_ = 0;
  position_ = s.start;
  velocity_.setZero();
  written_.fill(Vec3::Zero());
  taken_ = 0.0;
  return {};
}

void EmulatorDevice::move_on() noexcept {
  const HandPlace place = hand_->at(tick_ + 1);
  if (place.hold != 0 && place.hold != hold_) {
    hold_begin_ = hand_at_;
    hold_ = place.hold;
  }
  const Vec3 from = hand_at_;
  const Vec3 to = place.hold != 0 ? Vec3(hold_begin_ + place.position) : from;
  hand_at_ = to;
  const Vec3 speed = (to - from) / kTickSeconds;
  const std::uint64_t sent = tick_ - static_cast<std::uint64_t>(settings_.delay);
  const bool has_come = tick_ >= static_cast<std::uint64_t>(settings_.delay);
  const Vec3 force = has_come ? written_[sent % written_.size()] : Vec3(Vec3::Zero());

  Eigen::Matrix<double, 3, 3> before;  // rows: from the hand, its rate, the force that is not spent on friction with it
  before.row(0) = position_ - from;
  before.row(1) = velocity_ - speed;
  before.row(2) = force - settings_.damping * speed;
  const Eigen::Matrix<double, 2, 3> after = over_tick_ * before;
  const Vec3 reached = to + after.row(0).transpose();
  taken_ += force.dot(reached - position_);
  position_ = reached;
  velocity_ = speed + after.row(1).transpose();
  ++tick_;
  written_[tick_ % written_.size()].setZero();  // until something is written
}

Reading EmulatorDevice::read(std::uint64_t tick) noexcept {
  while (is_open_ && tick_ < tick) move_on();
  Reading reading;
  reading.present = is_open_;
  reading.position = position_;
  if (settings_.resolution > 0.0)
    for (int i = 0; i < 3; ++i)
      reading.position[i] = settings_.resolution * std::round(position_[i] / settings_.resolution);
  return reading;
}

void EmulatorDevice::write(const Vec3& force) noexcept {
  Vec3& slot = written_[tick_ % written_.size()];
  const double length = force.norm();
  slot = length > settings_.max_force ? Vec3(force * (settings_.max_force / length)) : force;
}

}  // namespace rhexis::haptics
