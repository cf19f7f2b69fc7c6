#pragma once

/// The device that holds the body, or the scene's script in its place while that runs. A device that follows the script
/// by itself needs nobody in its place.

#include <array>
#include <memory>
#include <utility>

#include "base/newest_value.h"
#include "haptics/device.h"
#include "haptics/script_device.h"

namespace rhexis::session {

class HandDevice final : public haptics::Device {
 public:
  /// `device` has to outlive this; opened and closed by whoever made it.
  HandDevice(haptics::Device& device, std::shared_ptr<haptics::HandPath> script)
      : device_(device), script_(std::move(script)) {}

  /// By one thread, while the hand holds nothing: from now on the device is followed along this direction alone (unit).
  void bind(const Vec3& direction) noexcept { directions_.publish({direction[0], direction[1], direction[2]}); }

  [[nodiscard]] const haptics::DeviceTraits& traits() const override { return device_.traits(); }
  haptics::Reading read(std::uint64_t tick) noexcept override {
    haptics::Reading reading = device_.read(tick);
    directions_.take(along_);
    if (const Vec3 along(along_[0], along_[1], along_[2]); !along.isZero(0.0))
      reading.position = along * along.dot(reading.position);
    if (traits().follows_script) return reading;
    const haptics::Reading scripted = script_.read(tick);
    is_scripted_ = scripted.present;
    if (!is_scripted_) return reading;
    reading.position = scripted.position;
    reading.present = true;
    return reading;
  }
  /// The script's force is nobody's to feel.
  void write(const Vec3& force) noexcept override { device_.write(is_scripted_ ? Vec3(Vec3::Zero()) : force); }
  [[nodiscard]] std::string diagnosis() const override { return device_.diagnosis(); }

 private:
  haptics::Device& device_;
  haptics::ScriptDevice script_;
  NewestValue<std::array<double, 3>> directions_;
  std::array<double, 3> along_{};  ///< the reader's; noughts: every direction
  bool is_scripted_ = false;       ///< in this tick, in its place
};

}  // namespace rhexis::session
