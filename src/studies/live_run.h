#pragma once

/// A live session with its server and its clients, all in this process, on the plate of the studies: torn by a script,
/// again and again, for as long as is asked.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "base/error.h"
#include "haptics/tick_statistics.h"
#include "studies/physics_log.h"
#include "studies/probed_device.h"
#include "studies/study_folder.h"
#include "studies/watching_client.h"

namespace rhexis::studies {

struct LiveOptions {
  double seconds = 600.0;
  int nodes = 20'000;               ///< of the plate
  int clients = 3;                  ///< at least 1
  std::string device = "emulator";  ///< one that follows the script
  int priority = 80;                ///< of the haptic loop, as haptics::LoopSettings
};

struct LiveRun {
  double seconds = 0.0;       ///< that it ran
  haptics::TickReport ticks;  ///< of the haptic loop
  std::string priority;       ///< of its thread, in words
  std::vector<TickMark> marks;
  std::vector<PhysicsEvent> events;
  std::vector<WatchRecord> clients;
  std::vector<double> steps_per_second;  ///< of the physics, of each second
  double longest_step = 0.0;             ///< ms
  int pulls = 0;                         ///< scripts begun
};

/// The scene is left in `folder`. Stopped by `progress`, it gives what there is. Errors: a plate or device that cannot
/// be, no port, a folder that cannot be written to, a client that was lost.
[[nodiscard]] Expected<LiveRun> run_live(const LiveOptions& options, const StudyFolder& folder,
                                         const Progress& progress);

}  // namespace rhexis::studies
