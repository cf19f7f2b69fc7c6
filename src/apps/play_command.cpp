// rhexis play SCENE [--device NAME] [--port 8080] [--set key=value ...]: the scene live, in a page.

#include <algorithm>
#include <filesystem>
#include <memory>
#include <utility>

#include "apps/live_view.h"
#include "apps/scene_options.h"
#include "haptics/device_list.h"
#include "haptics/pointer_device.h"
#include "session/live_session.h"

namespace rhexis::apps {
namespace {

namespace fs = std::filesystem;

/// The scenes beside this one, it among them.
std::vector<std::string> scenes_beside(const std::string& scene) {
  std::vector<std::string> out;
  fs::path folder = fs::path(scene).parent_path();
  if (folder.empty()) folder = ".";
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    if (entry.path().extension() == ".toml")
      out.push_back((fs::path(scene).parent_path() / entry.path().filename()).string());
  }
  if (std::find(out.begin(), out.end(), scene) == out.end()) out.push_back(scene);
  std::sort(out.begin(), out.end());
  return out;
}

struct PlayOptions {
  std::string device{haptics::PointerDevice::kName};
  double motion_scale = 1.0;
  double force_scale = 1.0;
  bool records = false;
};

int play(const SceneOptions& scene, const PlayOptions& options, const LiveViewOptions& view, const Common& common) {
  session::LiveSettings settings;
  settings.scene = scene.scene;
  settings.overrides = scene.overrides;
  settings.scenes = scenes_beside(scene.scene);
  settings.recordings = view.recordings;
  settings.records = options.records;
  settings.motion_scale = options.motion_scale;
  settings.force_scale = options.force_scale;
  settings.version = RHEXIS_VERSION;
  settings.device = [&](std::shared_ptr<haptics::HandPath> script) {
    return haptics::make_device(options.device,
                                {.hand = std::move(script), .emulator = haptics::EmulatorSettings::firmly_held()});
  };
  for (const haptics::DeviceTraits& device : haptics::known_devices()) settings.devices.push_back(device.name);
  Relay relay;
  Expected<std::unique_ptr<session::LiveSession>> live = session::LiveSession::open(std::move(settings), relay);
  if (!live) return report(live.error());
  const auto start = [&] {
    Expected<void> begun = (*live)->start();
    if (begun) say(common, "device    {}\n", options.device);
    return begun;
  };
  return serve(view, common, **live, relay, start, [&] { (*live)->stop(); });
}

}  // namespace

void add_play(CLI::App& app, const Common& common, int& code) {
  CLI::App* command = app.add_subcommand("play", "The scene live: hold, pull and tear it in a page");
  command->footer("Example: rhexis play scenes/plate-tear.toml --device emulator --force-scale 0.2");
  const auto scene = add_scene_options(*command);
  const auto view = add_live_view_options(*command);
  auto options = std::make_shared<PlayOptions>();
  command
      ->add_option("--device", options->device,
                   "what holds the body: a name from `rhexis devices`; pointer unless given")
      ->type_name("NAME");
  command
      ->add_option("--motion-scale", options->motion_scale, "m in the scene for a metre of the device; 1 unless given")
      ->type_name("FACTOR");
  command
      ->add_option("--force-scale", options->force_scale, "N at the device for a newton in the scene; 1 unless given")
      ->type_name("FACTOR");
  command->add_flag("--record", options->records, "record from the start");
  command->callback([=, &common, &code] { code = play(*scene, *options, *view, common); });
}

}  // namespace rhexis::apps
