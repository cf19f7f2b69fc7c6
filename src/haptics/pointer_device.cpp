#include "haptics/pointer_device.h"

namespace rhexis::haptics {

DeviceTraits PointerDevice::make_traits() {
  DeviceTraits traits;
  traits.name = kName;
  traits.what = "mouse, finger, pen or headset in the page; shows the force, cannot push back";
  traits.counts_from_hold = true;
  return traits;
}

void PointerDevice::move_to(const Vec3& position, std::uint32_t buttons) noexcept {
  newest_.publish({{position[0], position[1], position[2]}, buttons});
}

Reading PointerDevice::read(std::uint64_t) noexcept {
  newest_.take(target_);
  return {Vec3(target_.position[0], target_.position[1], target_.position[2]), target_.buttons, true};
}

}  // namespace rhexis::haptics
