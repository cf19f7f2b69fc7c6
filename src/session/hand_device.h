#pragma once

/// The device that holds the body, or the scene's script in its place while that runs.

#include "base/newest_value.h"
#include "haptics/device.h"
#include "session/scripted_pull.h"

namespace rhexis::session {

class HandDevice final : public haptics::Device {
 public:
  /// `device` has to outlive this; opened and closed by whoever made it.
  explicit HandDevice(haptics::Device& device) : device_(device) {}

  /// By the thread of the physics.
  void order(const ScriptedPull& pull) noexcept { orders_.publish(pull); }

  [[nodiscard]] const haptics::DeviceTraits& traits() const override { return device_.traits(); }
  haptics::Reading read(std::uint64_t tick) noexcept override {
    haptics::Reading reading = device_.read(tick);
    orders_.take(pull_);
    if (pull_.on == 0) return reading;
    reading.position = pull_.at(tick);
    reading.present = true;
    return reading;
  }
  /// The script's force is nobody's to feel.
  void write(const Vec3& force) noexcept override { device_.write(pull_.on != 0 ? Vec3(Vec3::Zero()) : force); }
  [[nodiscard]] std::string diagnosis() const override { return device_.diagnosis(); }

 private:
  haptics::Device& device_;
  NewestValue<ScriptedPull> orders_;
  ScriptedPull pull_;  ///< the reader's
};

}  // namespace rhexis::session
