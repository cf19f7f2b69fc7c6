#include "haptics/script_device.h"

namespace rhexis::haptics {

DeviceTraits ScriptDevice::make_traits() {
  DeviceTraits traits;
  traits.name = kName;
  traits.what = "the scene's pulls, one after the other";
  traits.counts_from_hold = true;
  traits.follows_script = true;
  return traits;
}

Reading ScriptDevice::read(std::uint64_t tick) noexcept {
  const HandPlace place = hand_->at(tick);
  return {.position = place.position, .buttons = 0, .present = place.hold != 0};
}

}  // namespace rhexis::haptics
