#pragma once

/// A device and the hand at it, emulated: a mass with friction, held by a spring and a damper that follow a path. It
/// takes the force, so that the loop is closed and its stability can be tested without a machine.
///
///     m x'' = F - b x' + k_h (h - x) + b_h (h' - x')      F: the force written, constant over a tick, `delay` ticks
///     old
///
/// Between two ticks F is constant and h runs straight on, so that the tick is integrated exactly.

#include <array>
#include <cstdint>
#include <memory>

#include <Eigen/Core>

#include "haptics/device.h"
#include "haptics/hand_path.h"

namespace rhexis::haptics {

/// The defaults are of the size of a small desktop device and a hand that holds it loosely.
struct EmulatorSettings {
  double mass = 0.1;             ///< kg, of device and finger
  double damping = 1.0;          ///< N s/m, of the device
  double hand_stiffness = 50.0;  ///< N/m
  double hand_damping = 2.0;     ///< N s/m
  int delay = 0;                 ///< ticks between the writing of a force and its acting; at most kMostDelay
  double resolution = 6e-5;      ///< m, of the position that is read; 0: exact
  double max_force = 8.9;        ///< N, what it can give; more is cut
  Vec3 start = Vec3::Zero();     ///< m, where it is in tick 0

  /// In a hand that means to pull: a firm one.
  [[nodiscard]] static EmulatorSettings firmly_held() { return {.hand_stiffness = 500.0, .hand_damping = 10.0}; }
};

class EmulatorDevice final : public Device {
 public:
  static constexpr const char* kName = "emulator";
  static DeviceTraits make_traits(const EmulatorSettings& settings);

  /// The hand is at 0 first, and stays where it is while its path holds nothing; a new hold begins there.
  EmulatorDevice(const EmulatorSettings& settings, std::shared_ptr<HandPath> hand);

  [[nodiscard]] const DeviceTraits& traits() const override { return traits_; }
  /// From tick 0, at the start. Errors: a mass that is not positive, a negative spring, damper or resolution, a delay
  /// out of range.
  Expected<void> open() override;
  /// Moves on by the ticks since the last reading. Not present when not open.
  Reading read(std::uint64_t tick) noexcept override;
  void write(const Vec3& force) noexcept override;
  void close() noexcept override { is_open_ = false; }

  [[nodiscard]] const Vec3& position() const { return position_; }  ///< m, exact
  [[nodiscard]] const Vec3& velocity() const { return velocity_; }  ///< m/s
  /// J, what the forces have given to the device, less what it gave: to its exact place, as no observer sees it.
  [[nodiscard]] double taken() const { return taken_; }

 private:
  void move_on() noexcept;

  EmulatorSettings settings_;
  DeviceTraits traits_;
  std::shared_ptr<HandPath> hand_;
  bool is_open_ = false;
  Eigen::Matrix<double, 2, 3> over_tick_;  ///< (x - h, x' - h') after a tick from those before it and a force of 1 N
  std::uint64_t tick_ = 0;
  Vec3 hand_at_ = Vec3::Zero();     ///< m
  Vec3 hold_begin_ = Vec3::Zero();  ///< m, of the hand
  std::uint32_t hold_ = 0;          ///< the last
  Vec3 position_ = Vec3::Zero();
  Vec3 velocity_ = Vec3::Zero();
  std::array<Vec3, kMostDelay + 1> written_;  ///< forces of the last ticks
  double taken_ = 0.0;
};

}  // namespace rhexis::haptics
