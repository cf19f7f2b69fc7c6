#pragma once

/// The haptic loop with what lies between it and the physics. A recording begins with a new one: its ticks count from
/// 0, and it knows of nothing before.

#include "base/newest_value.h"
#include "haptics/hand_state.h"
#include "haptics/loop.h"
#include "haptics/tick_ring.h"
#include "response/snapshot.h"
#include "session/hand_device.h"

namespace rhexis::session {

struct HandLoop {
  HandLoop(haptics::Device& of, std::shared_ptr<haptics::HandPath> script, const haptics::LoopSettings& settings)
      : device(of, std::move(script)), loop(device, laws, hands, trace, settings) {}

  NewestValue<response::ForceSnapshot> laws;
  NewestValue<haptics::HandState> hands;
  haptics::TickRing trace;
  HandDevice device;
  haptics::HapticLoop loop;
};

}  // namespace rhexis::session
