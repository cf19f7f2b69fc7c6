#pragma once

/// The devices by name: what `rhexis devices` lists. A driver is added here (docs/haptics.md).

#include <memory>
#include <string>
#include <vector>

#include "haptics/device.h"
#include "haptics/emulator_device.h"
#include "haptics/hand_path.h"

namespace rhexis::haptics {

/// What a device may want to know of the interaction that it is for. Each reads what concerns it.
struct DeviceRequest {
  std::shared_ptr<HandPath> hand;  ///< script: the hand itself; emulator: the hand that holds it
  EmulatorSettings emulator;
};

/// In the order of the list.
[[nodiscard]] std::vector<DeviceTraits> known_devices();

/// Not opened yet. Errors: an unknown name, with the nearest one; a hand that it needs and has not.
[[nodiscard]] Expected<std::unique_ptr<Device>> make_device(const std::string& name, DeviceRequest request);

}  // namespace rhexis::haptics
