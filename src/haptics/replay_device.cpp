#include "haptics/replay_device.h"

namespace rhexis::haptics {

DeviceTraits ReplayDevice::make_traits() {
  DeviceTraits traits;
  traits.name = kName;
  traits.what = "what a device gave in an interaction that was recorded";
  traits.counts_from_hold = true;
  return traits;
}

Reading ReplayDevice::read(std::uint64_t tick) noexcept {
  if (tick < readings_.size()) return readings_[tick];
  Reading reading;
  if (!readings_.empty()) reading = readings_.back();
  reading.present = false;
  return reading;
}

}  // namespace rhexis::haptics
