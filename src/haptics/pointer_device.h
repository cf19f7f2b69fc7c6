#pragma once

/// A pointer in the page: says where the hand is, cannot push back.

#include <array>
#include <cstdint>

#include "base/newest_value.h"
#include "haptics/device.h"

namespace rhexis::haptics {

class PointerDevice final : public Device {
 public:
  static constexpr const char* kName = "pointer";
  static DeviceTraits make_traits();

  /// m, of the hand from where it took hold. By one thread; before a hold is published, zero. What is not finite is
  /// refused by the tick, not here.
  void move_to(const Vec3& position, std::uint32_t buttons = 0) noexcept;

  [[nodiscard]] const DeviceTraits& traits() const override { return traits_; }
  Reading read(std::uint64_t tick) noexcept override;
  void write(const Vec3&) noexcept override {}

 private:
  struct Target {
    std::array<double, 3> position{};
    std::uint32_t buttons = 0;
  };

  DeviceTraits traits_ = make_traits();
  NewestValue<Target> newest_;
  Target target_;  ///< the reader's
};

}  // namespace rhexis::haptics
