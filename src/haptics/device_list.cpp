#include "haptics/device_list.h"

#include <utility>

#include <fmt/format.h>

#include "base/nearest_name.h"
#include "haptics/pointer_device.h"
#include "haptics/script_device.h"

namespace rhexis::haptics {

std::vector<DeviceTraits> known_devices() {
  return {PointerDevice::make_traits(), ScriptDevice::make_traits(), EmulatorDevice::make_traits({})};
}

Expected<std::unique_ptr<Device>> make_device(const std::string& name, DeviceRequest request) {
  if (name == PointerDevice::kName) return std::make_unique<PointerDevice>();
  if ((name == EmulatorDevice::kName || name == ScriptDevice::kName) && request.hand == nullptr)
    return fail(fmt::format("device '{}' has no hand that moves it", name), "a script");
  if (name == EmulatorDevice::kName) return std::make_unique<EmulatorDevice>(request.emulator, std::move(request.hand));
  if (name == ScriptDevice::kName) return std::make_unique<ScriptDevice>(std::move(request.hand));
  std::vector<std::string> names;
  for (const DeviceTraits& traits : known_devices()) names.push_back(traits.name);
  const std::string near = nearest_name(name, names);
  return fail(fmt::format("unknown device '{}'", name),
              near.empty() ? fmt::format("one of {}", fmt::join(names, ", ")) : "did you mean '" + near + "'?");
}

}  // namespace rhexis::haptics
