#pragma once

/// A device of which every tick is noted: when it was read and written, and what the system did to the haptic thread.

#include <chrono>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "haptics/device.h"

namespace rhexis::studies {

/// ns, of the clock that all marks of a live run are on.
[[nodiscard]] inline std::int64_t now_ns() noexcept {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

struct TickMark {
  std::int64_t read = 0;     ///< ns, before the device was
  std::int64_t written = 0;  ///< ns, after the device had the force
  // Of the haptic thread, until this tick was read.
  std::int32_t preempted = 0;  ///< times that the system took its processor away
  std::int32_t waited = 0;     ///< times that it gave it up itself: the sleep of each tick is one
  std::int32_t faults = 0;     ///< pages that were not there
  bool moved = false;          ///< to another place than in the tick before
  bool pushed = false;         ///< a force was written
};

class ProbedDevice final : public haptics::Device {
 public:
  /// Room for `ticks` marks, taken at once: in a tick it takes no memory.
  ProbedDevice(std::unique_ptr<haptics::Device> device, std::size_t ticks)
      : device_(std::move(device)), marks_(ticks) {}

  [[nodiscard]] const haptics::DeviceTraits& traits() const override { return device_->traits(); }
  Expected<void> open() override { return device_->open(); }
  haptics::Reading read(std::uint64_t tick) noexcept override;
  void write(const Vec3& force) noexcept override;
  void close() noexcept override { device_->close(); }
  [[nodiscard]] std::string diagnosis() const override { return device_->diagnosis(); }

  /// Of the ticks so far, from tick 0; those for which there was no room are left out. Once the loop has ended.
  [[nodiscard]] std::vector<TickMark> take_marks();

 private:
  std::unique_ptr<haptics::Device> device_;
  std::vector<TickMark> marks_;
  std::uint64_t tick_ = 0;   ///< the present one
  std::uint64_t ticks_ = 0;  ///< read so far
  Vec3 position_ = Vec3::Zero();
};

}  // namespace rhexis::studies
