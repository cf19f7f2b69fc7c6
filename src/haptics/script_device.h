#pragma once

/// A hand that moves by a script: demonstrations, tests, measurements.

#include "haptics/device.h"
#include "haptics/motion.h"

namespace rhexis::haptics {

class ScriptDevice final : public Device {
 public:
  static constexpr const char* kName = "script";
  static constexpr std::uint32_t kHolds =
      1;  ///< button: pressed while a leg lasts; let go for the last tick of one that lets go
  static DeviceTraits make_traits();

  explicit ScriptDevice(Motion motion) : motion_(std::move(motion)) {}

  [[nodiscard]] const DeviceTraits& traits() const override { return traits_; }
  /// Not present when the motion is over.
  Reading read(std::uint64_t tick) noexcept override;
  void write(const Vec3&) noexcept override {}

 private:
  DeviceTraits traits_ = make_traits();
  Motion motion_;
};

}  // namespace rhexis::haptics
