#pragma once

/// The hand that a script moves, between the thread of the physics, which orders, and that of the haptic loop.

#include "base/newest_value.h"
#include "haptics/hand_path.h"
#include "session/scripted_pull.h"

namespace rhexis::session {

class ScriptedHand final : public haptics::HandPath {
 public:
  /// By the thread of the physics.
  void order(const ScriptedPull& pull) noexcept { orders_.publish(pull); }

  haptics::HandPlace at(std::uint64_t tick) noexcept override {
    orders_.take(pull_);
    return {.position = pull_.at(tick), .hold = pull_.hold};
  }

 private:
  NewestValue<ScriptedPull> orders_;
  ScriptedPull pull_;  ///< the reader's
};

}  // namespace rhexis::session
