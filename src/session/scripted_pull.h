#pragma once

/// One pull of a scene's script on the clock of the haptic loop: what the physics tells the hand's device to do.

#include <algorithm>
#include <array>
#include <cstdint>

#include "base/vec.h"

namespace rhexis::session {

/// Copied as bytes from the physics to the haptic loop.
struct ScriptedPull {
  std::uint32_t hold =
      0;  ///< counts the pulls from 1; 0: nothing is scripted, the device itself says where the hand is
  std::uint32_t runs = 0;      ///< 0: it stands still (paused)
  std::uint64_t since = 0;     ///< tick of the haptic loop from which it runs on
  std::uint64_t elapsed = 0;   ///< ticks that the pull had taken then
  std::uint64_t moving = 1;    ///< ticks that the way takes; then it is held
  std::array<double, 3> by{};  ///< m, the whole way

  [[nodiscard]] Vec3 at(std::uint64_t tick) const noexcept {
    const std::uint64_t taken = elapsed + (runs != 0 && tick > since ? tick - since : 0);
    const double part = static_cast<double>(std::min(taken, moving)) / static_cast<double>(moving);
    return part * Vec3(by[0], by[1], by[2]);
  }
  friend bool operator==(const ScriptedPull&, const ScriptedPull&) = default;
};

}  // namespace rhexis::session
