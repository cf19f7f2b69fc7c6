#pragma once

/// What holds is exactly where the script has it: demonstrations, tests, measurements.

#include <memory>
#include <utility>

#include "haptics/device.h"
#include "haptics/hand_path.h"

namespace rhexis::haptics {

class ScriptDevice final : public Device {
 public:
  static constexpr const char* kName = "script";
  static DeviceTraits make_traits();

  explicit ScriptDevice(std::shared_ptr<HandPath> hand) : hand_(std::move(hand)) {}

  [[nodiscard]] const DeviceTraits& traits() const override { return traits_; }
  /// Not present while the script holds nothing.
  Reading read(std::uint64_t tick) noexcept override;
  void write(const Vec3&) noexcept override {}

 private:
  DeviceTraits traits_ = make_traits();
  std::shared_ptr<HandPath> hand_;
};

}  // namespace rhexis::haptics
