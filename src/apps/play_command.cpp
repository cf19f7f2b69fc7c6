// rhexis play SCENE [--port 8080]: the scene live, in a page. rhexis replay RECORDING [--check]. rhexis devices.

#include <algorithm>
#include <filesystem>
#include <utility>

#include "apps/live_view.h"
#include "apps/progress.h"
#include "apps/scene_options.h"
#include "haptics/device_list.h"
#include "session/live_session.h"
#include "session/replay_check.h"
#include "session/replay_source.h"

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

int check(const std::string& recording, const Common& common) {
  Expected<session::CheckReport> checked;
  {
    Progress progress(!common.quiet);
    checked = session::check_recording(recording, [&](double part) { progress.update(part, "computing again"); });
  }
  if (!checked) return report(checked.error());
  if (!checked->difference.empty()) {
    fmt::print(stderr, "rhexis: {}: {}\n", recording, checked->difference);
    return kFailedComputation;
  }
  say(common, "the same bits: {} haptic ticks, {} steps, {} advances\n", checked->ticks, checked->steps,
      checked->advances);
  return kDone;
}

int replay(const std::string& recording, const LiveViewOptions& view, const Common& common) {
  Relay relay;
  Expected<std::unique_ptr<session::ReplaySource>> source = session::ReplaySource::open(recording, relay);
  if (!source) return report(source.error());
  return serve(
      view, common, **source, relay,
      [&] {
        (*source)->start();
        return Expected<void>{};
      },
      [&] { (*source)->stop(); });
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

void add_replay(CLI::App& app, const Common& common, int& code) {
  CLI::App* command = app.add_subcommand("replay", "Play a recorded interaction in the page, or check its bits");
  command->footer("Example: rhexis replay out/recordings/plate-tear.h5 --check");
  auto recording = std::make_shared<std::string>();
  auto checks = std::make_shared<bool>(false);
  command->add_option("recording", *recording, "file that play has recorded (docs/recording.md)")->required();
  command->add_flag("--check", *checks, "compute it again, and fail on the first bit that differs");
  const auto view = add_live_view_options(*command);
  command->callback(
      [=, &common, &code] { code = *checks ? check(*recording, common) : replay(*recording, *view, common); });
}

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
