#include "haptics/script_device.h"

namespace rhexis::haptics {

DeviceTraits ScriptDevice::make_traits() {
  DeviceTraits traits;
  traits.name = kName;
  traits.what = "the scene's pulls, one after the other";
  traits.counts_from_hold = true;
  return traits;
}

Reading ScriptDevice::read(std::uint64_t tick) noexcept {
  Reading reading;
  const Motion::Place here = motion_.at(tick);
  reading.position = here.position;
  reading.present = tick <= motion_.ticks();
  const bool goes_on = here.leg < motion_.legs().size() && motion_.at(tick + 1).leg == here.leg;
  if (reading.present && (goes_on || !motion_.legs()[here.leg].lets_go)) reading.buttons = kHolds;
  return reading;
}

}  // namespace rhexis::haptics
