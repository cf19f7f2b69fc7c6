#pragma once

/// How the physics and the haptic loop have done over the last second.

#include <array>
#include <chrono>
#include <cstdint>

#include "haptics/loop.h"
#include "wire/frame.h"

namespace rhexis::session {

class LiveRates {
 public:
  using Clock = std::chrono::steady_clock;

  /// After a step of the physics that took `seconds` and published law `number`, while the loop feels law `felt`.
  void add_step(double seconds, std::uint64_t number, std::uint64_t felt, haptics::HapticLoop& loop);
  /// A new haptic loop, and a new count of laws.
  void restart();
  [[nodiscard]] const wire::RatesT& latest() const { return latest_; }

 private:
  static constexpr std::size_t kRemembered = 1024;

  std::array<Clock::time_point, kRemembered> published_{};  ///< of law number modulo their count
  Clock::time_point since_ = Clock::now();
  std::uint64_t steps_ = 0;
  std::uint64_t ticks_before_ = 0;
  double worst_ = 0.0;  ///< s
  double age_ = 0.0;    ///< s
  wire::RatesT latest_;
};

}  // namespace rhexis::session
