#pragma once

/// What a live session is told at its start.

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "haptics/device.h"
#include "haptics/hand_path.h"
#include "session/live_task.h"

namespace rhexis::session {

/// What holds the body. `script`: the hand that goes through the scene's pulls, for a device that follows it.
using MakeDevice = std::function<Expected<std::unique_ptr<haptics::Device>>(std::shared_ptr<haptics::HandPath> script)>;

struct LiveSettings {
  std::shared_ptr<LiveTask> task;      ///< which opens a body of its own, and leaves `scene` to nobody; null: free play
  std::string scene;                   ///< file, to begin with
  std::vector<std::string> overrides;  ///< "key=value", of that scene
  std::vector<std::string> scenes;     ///< files that a client may open
  std::filesystem::path recordings;    ///< folder; empty: nothing can be recorded
  bool records = false;                ///< from the start
  std::string version;                 ///< of rhexis
  std::vector<std::string> devices;    ///< names, for clients
  MakeDevice device;                   ///< empty: the pointer in the page
  double motion_scale = 1.0;           ///< as haptics::TickSettings; all else of those is as the device asks for
  double force_scale = 1.0;            ///< as haptics::TickSettings
  int priority = 80;                   ///< of the haptic loop, as LoopSettings
};

}  // namespace rhexis::session
