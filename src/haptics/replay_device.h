#pragma once

/// What a device has given in an earlier interaction, tick by tick.

#include <utility>
#include <vector>

#include "haptics/device.h"

namespace rhexis::haptics {

class ReplayDevice final : public Device {
 public:
  static constexpr const char* kName = "replay";
  static DeviceTraits make_traits();

  /// One reading a tick, from tick 0. `recorded_from`: the device that gave them, whose place and force this one takes.
  explicit ReplayDevice(std::vector<Reading> readings, DeviceTraits recorded_from = make_traits())
      : traits_(std::move(recorded_from)), readings_(std::move(readings)) {}

  [[nodiscard]] const DeviceTraits& traits() const override { return traits_; }
  /// Not present when the recording is over.
  Reading read(std::uint64_t tick) noexcept override;
  void write(const Vec3&) noexcept override {}

 private:
  DeviceTraits traits_;
  std::vector<Reading> readings_;
};

}  // namespace rhexis::haptics
