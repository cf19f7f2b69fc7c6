#include "haptics/tick_settings.h"

#include <cmath>
#include <complex>
#include <numbers>

#include <fmt/format.h>

namespace rhexis::haptics {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// What a desktop device takes with any hand (docs/haptics.md has the map): twice the damping that is needed.
constexpr double kStiffness = 1500.0;  // N/m
constexpr double kDamping = 1.5;       // N s/m

/// Hz, that passive_below() is asked about: half the rate of the loop is the highest that sampling knows.
constexpr double kHighest = 0.5 / kTickSeconds;

}  // namespace

TickSettings settings_for(const DeviceTraits& traits) {
  TickSettings settings;
  settings.max_force = traits.max_force;
  if (traits.max_force > 0.0) {
    settings.stiffness = kStiffness;
    settings.damping = kDamping;
  }
  return settings;
}

Expected<void> check_settings(const TickSettings& s) {
  const auto positive = [](double value) { return value > 0.0 && std::isfinite(value); };
  const auto not_negative = [](double value) { return value >= 0.0 && std::isfinite(value); };
  if (!(s.stiffness > 0.0)) return fail(fmt::format("a coupling of {} N/m", s.stiffness), "more than 0");
  if (!not_negative(s.damping)) return fail(fmt::format("a damping of {} N s/m", s.damping), "0 or more");
  if (!positive(s.velocity_cutoff)) return fail(fmt::format("a low-pass of {} Hz", s.velocity_cutoff), "more than 0");
  if (!positive(s.motion_scale) || !positive(s.force_scale))
    return fail(fmt::format("motion scaled by {}, force by {}", s.motion_scale, s.force_scale), "more than 0");
  if (!not_negative(s.max_force)) return fail(fmt::format("a force of at most {} N", s.max_force), "0 or more");
  if (!s.is_rigid() && s.max_force == 0.0) return fail("a device that pushes back without a limit", "give max_force");
  if (s.ramp_ticks < 1) return fail(fmt::format("a ramp of {} ticks", s.ramp_ticks), "1 or more");
  if (s.late_ticks < 0 || s.lost_ticks <= s.late_ticks)
    return fail(fmt::format("laws are late after {} ticks, lost after {}", s.late_ticks, s.lost_ticks),
                "late 0 or more, lost after late");
  if (!not_negative(s.most_restraint) || !not_negative(s.reserve))
    return fail(fmt::format("a restraint of {} N s/m, a reserve of {} J", s.most_restraint, s.reserve), "0 or more");
  return {};
}

double smoothing_of(double cutoff) { return 1.0 - std::exp(-2.0 * std::numbers::pi * cutoff * kTickSeconds); }

double passive_below(const TickSettings& settings) {
  if (settings.is_rigid()) return kInfinite;
  const double a = smoothing_of(settings.velocity_cutoff);
  // What the damper takes from a motion of this frequency, over what sampling gives to it.
  const auto takes_more = [&](double hertz) {
    const double turn = 2.0 * std::numbers::pi * hertz * kTickSeconds;
    const std::complex<double> back = std::polar(1.0, -turn);
    const std::complex<double> filter = a / (1.0 - (1.0 - a) * back);
    return settings.damping * (filter * back).real() > 0.5 * settings.stiffness * kTickSeconds;
  };
  if (!takes_more(0.0)) return 0.0;
  double below = 0.0;
  double above = kHighest;  // there back is -1, and the damper gives
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (below + above);
    (takes_more(middle) ? below : above) = middle;
  }
  return below;
}

}  // namespace rhexis::haptics
