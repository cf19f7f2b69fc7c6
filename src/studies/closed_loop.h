#pragma once

/// The haptic loop around an emulated device in an emulated hand: whether it comes to rest.

#include "base/error.h"
#include "haptics/emulator_device.h"
#include "haptics/tick_settings.h"

namespace rhexis::studies {

struct ClosedLoop {
  haptics::TickSettings tick;
  haptics::EmulatorSettings device;
  double body_stiffness = 1e6;  ///< N/m, in every direction
  int ticks = 4000;             ///< at least kKick + kWatched
};
inline constexpr int kKick = 200;      ///< ticks at rest before the hand jumps aside
inline constexpr int kWatched = 1000;  ///< ticks, the last

/// How far and within how many ticks the hand jumps.
inline constexpr double kJump = 4e-3;  // m
inline constexpr int kJumpTicks = 20;

struct ClosedLoopRun {
  double shake = 0.0;  ///< m, between the furthest places of the ticks watched
  double force = 0.0;  ///< N, the largest in all
  double gain = 1.0;   ///< of the elastic force, at the end
  double given = 0.0;  ///< J, to the device in all, less what it gave
};

/// A hand that holds still jumps aside and holds still again: all frequencies are there. Errors: too few ticks,
/// settings or a device that cannot be.
[[nodiscard]] Expected<ClosedLoopRun> run_closed_loop(const ClosedLoop& loop);

/// N/m: a coupling softer than this, before a body that is much stiffer, is stable without control of energy,
/// k (T / 2 + delay) < b + b_hand + b_coupling (Gil et al. 2009, after Colgate and Brown 1994). Good for delays that
/// are short beside the mass over the damping.
[[nodiscard]] double stable_stiffness(const haptics::TickSettings& tick, const haptics::EmulatorSettings& device);

}  // namespace rhexis::studies
