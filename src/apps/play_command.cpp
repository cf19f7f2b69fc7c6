// rhexis play SCENE [--port 8080] [--set key=value ...]: the scene live, in a page.

#include <algorithm>
#include <filesystem>
#include <utility>

#include "apps/live_view.h"
#include "apps/scene_options.h"
#include "haptics/device_list.h"
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

int play(const SceneOptions& scene, bool records, const LiveViewOptions& view, const Common& common) {
  session::LiveSettings settings;
  settings.scene = scene.scene;
  settings.overrides = scene.overrides;
  settings.scenes = scenes_beside(scene.scene);
  settings.recordings = view.recordings;
  settings.records = records;
  settings.version = RHEXIS_VERSION;
  for (const haptics::DeviceTraits& device : haptics::known_devices()) settings.devices.push_back(device.name);
  Relay relay;
  Expected<std::unique_ptr<session::LiveSession>> live = session::LiveSession::open(std::move(settings), relay);
  if (!live) return report(live.error());
  return serve(
      view, common, **live, relay, [&] { return (*live)->start(); }, [&] { (*live)->stop(); });
}

}  // namespace

void add_play(CLI::App& app, const Common& common, int& code) {
  CLI::App* command = app.add_subcommand("play", "The scene live: hold, pull and tear it in a page");
  command->footer("Example: rhexis play scenes/plate-tear.toml --port 8080");
  const auto scene = add_scene_options(*command);
  const auto view = add_live_view_options(*command);
  auto records = std::make_shared<bool>(false);
  command->add_flag("--record", *records, "record from the start");
  command->callback([=, &common, &code] { code = play(*scene, *records, *view, common); });
}

}  // namespace rhexis::apps
