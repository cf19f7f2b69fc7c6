// The haptic loop around an emulated device: at rest below the analytic bound, shaking above it, and what the control
// of energy makes of that.

#include "studies/closed_loop.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "studies/stability_map.h"

namespace rhexis::studies {
namespace {

using testing::HasSubstr;

/// A body that hardly gives way; `part` of the stiffness of the bound.
ClosedLoop loop_at(double part, int delay, double resolution, bool restrains) {
  ClosedLoop loop;
  loop.device.delay = delay;
  loop.device.resolution = resolution;
  loop.device.max_force = 1e3;  // the bound is of a loop without a limit
  loop.tick = haptics::settings_for(haptics::EmulatorDevice::make_traits(loop.device));
  loop.tick.stiffness = part * stable_stiffness(loop.tick, loop.device);
  loop.tick.restrains = restrains;
  return loop;
}

ClosedLoopRun ran(const ClosedLoop& loop) {
  const Expected<ClosedLoopRun> run = run_closed_loop(loop);
  EXPECT_TRUE(run);
  return run ? *run : ClosedLoopRun{};
}

TEST(ClosedLoop, RestsBelowTheBoundAndShakesAboveIt) {
  for (const int delay : {0, 1, 2, 4, 8}) {
    for (const double resolution : {0.0, 6e-5}) {
      SCOPED_TRACE(testing::Message() << delay << " ticks, " << resolution << " m");
      EXPECT_LT(ran(loop_at(0.7, delay, resolution, false)).shake, kAtRest);
      const ClosedLoopRun above = ran(loop_at(1.5, delay, resolution, false));
      EXPECT_GT(above.shake, 10.0 * kAtRest);
      EXPECT_GT(above.given, 0.0);
    }
  }
}

TEST(ClosedLoop, ControlOfEnergyHoldsWhatShakesByItself) {
  for (const int delay : {0, 1, 2, 4, 8}) {
    SCOPED_TRACE(delay);
    const ClosedLoopRun free = ran(loop_at(1.5, delay, 6e-5, false));
    const ClosedLoopRun kept = ran(loop_at(1.5, delay, 6e-5, true));
    EXPECT_GT(free.shake, 10.0 * kAtRest);
    EXPECT_LT(kept.shake, delay < 2 ? 2e-3 : kAtRest) << "of a quick shake half steps are a part that is not seen";
    EXPECT_LT(kept.given, 0.01 * free.given);
  }
}

TEST(ClosedLoop, WhatCannotBeIsRefused) {
  ClosedLoop loop = loop_at(0.5, 0, 0.0, true);
  loop.ticks = 10;
  EXPECT_THAT(run_closed_loop(loop).error().message(), HasSubstr("10 ticks"));
  loop = loop_at(0.5, 0, 0.0, true);
  loop.device.mass = 0.0;
  EXPECT_THAT(run_closed_loop(loop).error().message(), HasSubstr("mass"));
  loop = loop_at(0.5, 0, 0.0, true);
  loop.tick.damping = -1.0;
  EXPECT_THAT(run_closed_loop(loop).error().message(), HasSubstr("damping"));
}

}  // namespace
}  // namespace rhexis::studies
