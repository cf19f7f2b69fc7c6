#pragma once

/// What a live session is told at its start.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "haptics/device.h"
#include "haptics/tick_settings.h"

namespace rhexis::session {

struct LiveSettings {
  std::string scene;                          ///< file, to begin with
  std::vector<std::string> overrides;         ///< "key=value", of that scene
  std::vector<std::string> scenes;            ///< files that a client may open
  std::filesystem::path recordings;           ///< folder; empty: nothing can be recorded
  bool records = false;                       ///< from the start
  std::string version;                        ///< of rhexis
  std::vector<std::string> devices;           ///< names, for clients
  haptics::Device* device = nullptr;          ///< outlives the session; null: the pointer in the page
  std::optional<haptics::TickSettings> tick;  ///< empty: haptics::settings_for the device
  int priority = 80;                          ///< of the haptic loop, as LoopSettings
};

}  // namespace rhexis::session
