#pragma once

/// The haptic loop: a thread of its own that ticks a thousand times a second. In a tick it takes no memory and no lock,
/// and asks the system for the time, for sleep until the next tick, and for what its device needs; nothing else.

#include <atomic>
#include <cstdint>
#include <string>
#include <thread>

#include "base/newest_value.h"
#include "haptics/device.h"
#include "haptics/hand_state.h"
#include "haptics/tick.h"
#include "haptics/tick_ring.h"
#include "haptics/tick_statistics.h"
#include "response/snapshot.h"

namespace rhexis::haptics {

struct LoopSettings {
  TickSettings tick;
  /// Of SCHED_FIFO, where the system allows it; 0: not asked for.
  int priority = 80;
};

class HapticLoop {
 public:
  /// All have to outlive the loop. It is the one reader of `laws`, the one writer of `hand` and `trace`.
  HapticLoop(Device& device, NewestValue<response::ForceSnapshot>& laws, NewestValue<HandState>& hand, TickRing& trace,
             const LoopSettings& settings);
  ~HapticLoop();  ///< stops
  HapticLoop(const HapticLoop&) = delete;
  HapticLoop& operator=(const HapticLoop&) = delete;

  /// Opens the device and begins to tick, from tick 0. Errors: settings that contradict themselves; what the device
  /// says; no thread.
  Expected<void> start();
  /// After the tick under way: the device is given zero force and closed. May be called twice, and before start.
  void stop();

  [[nodiscard]] TickReport statistics() const { return statistics_.report(); }
  /// us, the longest lateness since the last call, by one reader.
  [[nodiscard]] double take_worst() { return statistics_.take_worst(); }
  /// Whether the thread has real-time priority, and what that means where it has not; known when start has returned.
  [[nodiscard]] bool is_realtime() const { return realtime_; }
  [[nodiscard]] const std::string& priority_text() const { return priority_text_; }

 private:
  void run() noexcept;
  void ask_for_priority();

  Device& device_;
  NewestValue<response::ForceSnapshot>& laws_;
  NewestValue<HandState>& hand_;
  TickRing& trace_;
  LoopSettings settings_;
  TickStatistics statistics_;
  std::atomic<bool> stops_{false};
  bool realtime_ = false;
  std::string priority_text_;
  std::thread thread_;
};

}  // namespace rhexis::haptics
