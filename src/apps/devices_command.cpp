// rhexis devices: what can hold the body.

#include "apps/command.h"
#include "haptics/device_list.h"

namespace rhexis::apps {

void add_devices(CLI::App& app, const Common& common, int& code) {
  CLI::App* command = app.add_subcommand("devices", "What can hold the body");
  command->footer("Example: rhexis devices");
  command->callback([&common, &code] {
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    for (const haptics::DeviceTraits& device : haptics::known_devices()) {
      rows.push_back({{"name", device.name},
                      {"what", device.what},
                      {"reach_m", device.reach},
                      {"resolution_m", device.resolution},
                      {"max_force_N", device.max_force}});
      if (!common.json) say(common, "{:<10} {}\n", device.name, device.what);
    }
    if (common.json) print_json(rows);
    code = kDone;
  });
}

}  // namespace rhexis::apps
