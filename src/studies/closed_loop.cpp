#include "studies/closed_loop.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <vector>

#include <fmt/format.h>

#include "haptics/motion.h"
#include "haptics/tick.h"
#include "response/snapshot.h"

namespace rhexis::studies {
namespace {

using response::ForceSnapshot;

/// m: a direction that is none of the axes.
const Vec3 kAside = kJump * Vec3(2.0, -1.0, 2.0) / 3.0;

ForceSnapshot law_of(double stiffness) {
  ForceSnapshot law;
  for (std::size_t i = 0; i < 3; ++i) law.stiffness[4 * i] = stiffness;
  law.normal = {0.0, 0.0, 1.0};
  law.flags = ForceSnapshot::is_held;
  law.grasp = 1;
  law.number = 1;
  return law;
}

}  // namespace

Expected<ClosedLoopRun> run_closed_loop(const ClosedLoop& loop) {
  if (loop.ticks < kKick + kWatched)
    return fail(fmt::format("{} ticks of a closed loop", loop.ticks), fmt::format("{} or more", kKick + kWatched));
  if (Expected<void> good = haptics::check_settings(loop.tick); !good) return fail(good.error());
  const std::vector<haptics::Leg> legs{{.seconds = kKick * haptics::kTickSeconds},
                                       {.by = kAside, .seconds = kJumpTicks * haptics::kTickSeconds}};
  haptics::EmulatorDevice device(loop.device, std::make_shared<haptics::Motion>(legs));
  if (Expected<void> opened = device.open(); !opened) return fail(opened.error());
  haptics::HapticTick tick(loop.tick, device.traits());
  const ForceSnapshot law = law_of(loop.body_stiffness);
  ClosedLoopRun out;
  Vec3 least = Vec3::Constant(std::numeric_limits<double>::infinity());
  Vec3 most = -least;
  for (int t = 0; t < loop.ticks; ++t) {
    const haptics::TickOutput felt = tick.step(device.read(static_cast<std::uint64_t>(t)), law, true);
    device.write(felt.force);
    out.force = std::max(out.force, felt.force.norm());
    out.gain = felt.gain;
    if (t < loop.ticks - kWatched) continue;
    least = least.cwiseMin(device.position());
    most = most.cwiseMax(device.position());
  }
  out.shake = (most - least).norm();
  out.given = device.taken();
  return out;
}

double stable_stiffness(const haptics::TickSettings& tick, const haptics::EmulatorSettings& device) {
  const double late = (0.5 + device.delay) * haptics::kTickSeconds;
  return (device.damping + device.hand_damping + tick.damping) / late;
}

}  // namespace rhexis::studies
