#pragma once

/// What can hold the body. A device gives where it is and takes a force, a thousand times a second; the loop knows no
/// more of it, so that a pointer in a page, a script, a recording, an emulated machine and a driver are alike.

#include <cstdint>
#include <string>

#include "base/error.h"
#include "base/vec.h"

namespace rhexis::haptics {

/// What a device gives in one tick.
struct Reading {
  Vec3 position = Vec3::Zero();  ///< m, in the device's frame
  std::uint32_t buttons = 0;     ///< a bit each
  bool present = true;           ///< false: lost (unplugged, its client gone, its script at an end)
};

inline constexpr int kMostDelay = 63;  ///< ticks

/// What is fixed while a device is open.
struct DeviceTraits {
  std::string name;         ///< of `--device`
  std::string what;         ///< one line, for `rhexis devices`
  double reach = 0.0;       ///< m, edge of the cube it works in; 0: unbounded
  double resolution = 0.0;  ///< m; 0: none worth the name
  double max_force = 0.0;   ///< N; 0: it cannot push back
  /// Ticks from the writing of a force until it acts, beyond none, as far as is known; at most kMostDelay. Who watches
  /// the energy has to know.
  int delay = 0;
  /// Its position counts from where the hand took hold, as a pointer's does. Else the loop notes where that was.
  bool counts_from_hold = false;
  /// The hand at it is the scene's script, which takes hold by itself. Else a point is held where a page says.
  bool follows_script = false;
};

/// Life: made, opened, read and written by one thread in turn, closed. A driver that has to load firmware or find its
/// device again does so in `open` and in a thread of its own; `read` then says present = false until it is there.
class Device {
 public:
  virtual ~Device() = default;
  [[nodiscard]] virtual const DeviceTraits& traits() const = 0;
  /// May take time and memory. Errors: not there, not ours to use; in words, with what would help.
  virtual Expected<void> open() { return {}; }
  /// In a tick: no memory, no lock, no waiting. `tick` counts from 0, one millisecond each.
  virtual Reading read(std::uint64_t tick) noexcept = 0;
  /// The force (N, on the hand) for this tick; the same rules.
  virtual void write(const Vec3& force) noexcept = 0;
  virtual void close() noexcept {}
  /// What the device has to say about itself: firmware, calibration, lost packets; lines. Not in a tick.
  [[nodiscard]] virtual std::string diagnosis() const { return {}; }
};

}  // namespace rhexis::haptics
