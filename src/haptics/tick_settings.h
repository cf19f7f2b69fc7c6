#pragma once

/// The numbers of the haptic loop, each with its unit and the inequality that it controls (docs/haptics.md derives
/// them). What a device feels is measured at the device: a coupling of 1500 N/m is that whatever the scales are.

#include <limits>

#include "haptics/device.h"

namespace rhexis::haptics {

inline constexpr double kTickSeconds = 1e-3;

struct TickSettings {
  /// N/m, of the spring between device and virtual hand. No body feels stiffer than this. Infinite: the hand is where
  /// the device is, for devices that cannot push back; no coupling, no damping and no control of energy then.
  double stiffness = std::numeric_limits<double>::infinity();
  /// N s/m, beside a spring as stiff as the coupling; beside a softer body less, in proportion. More than
  /// stiffness * kTickSeconds / 2, so that the held body gives out no energy (passive_below()).
  double damping = 0.0;
  /// Hz, where the first-order low-pass of the velocity has fallen by 3 dB.
  double velocity_cutoff = 100.0;
  double motion_scale = 1.0;  ///< m of the scene for a metre of the device
  double force_scale = 1.0;   ///< N at the device for a newton of the scene
  /// N, on the length of the force at the device; 0: none. The smallest of this, the scene's and the device's holds.
  double max_force = 0.0;
  int ramp_ticks = 50;   ///< after taking hold, letting go, or a gap: until the force is there, or gone
  int late_ticks = 100;  ///< a law may be so old before the force fades
  int lost_ticks = 300;  ///< > late_ticks: so old, the physics is lost and the force zero
  /// Whether energy is watched and taken back.
  bool restrains = true;
  /// N s/m, the most damping by which it is taken back. Less than the mass of the lightest device over kTickSeconds,
  /// by a factor of ten: more would overshoot.
  double most_restraint = 10.0;
  /// J: what the hand has lost to the loop may come back to it, but no more than this at a time.
  double reserve = 0.1;

  [[nodiscard]] bool is_rigid() const { return stiffness == std::numeric_limits<double>::infinity(); }
};

/// For a device: rigid when it cannot push back; else a coupling that is passive by itself, and within its force.
[[nodiscard]] TickSettings settings_for(const DeviceTraits& traits);

/// Errors: a number out of range, or one that contradicts another; in words.
[[nodiscard]] Expected<void> check_settings(const TickSettings& settings);

/// The part that a new value has in a first-order low-pass of this cut-off (Hz), once a tick.
[[nodiscard]] double smoothing_of(double cutoff);

/// Hz: the held body gives out no energy over any closed loop of motions below this frequency; 0 where the damping is
/// too small for any, infinite for a rigid hold, which no device feels.
[[nodiscard]] double passive_below(const TickSettings& settings);

}  // namespace rhexis::haptics
