#pragma once

/// What a recording says of itself before anything has happened: with what it was made, and how the haptic loop was
/// set.

#include <string>

#include "haptics/device.h"
#include "haptics/tick_settings.h"

namespace rhexis::session {

struct RecordingHead {
  std::string version;  ///< of rhexis
  std::string device;   ///< its name
  haptics::TickSettings tick;
  double device_max_force = 0.0;   ///< N, of DeviceTraits
  double device_resolution = 0.0;  ///< m, of DeviceTraits
  int device_delay = 0;            ///< ticks, of DeviceTraits
  bool counts_from_hold = false;   ///< of DeviceTraits

  /// What a HapticTick has to know of the device.
  [[nodiscard]] haptics::DeviceTraits traits() const;
};

[[nodiscard]] std::string text_of(const RecordingHead& head);
/// Errors: not such a text, settings that contradict themselves.
[[nodiscard]] Expected<RecordingHead> parse_recording_head(const std::string& text);

}  // namespace rhexis::session
