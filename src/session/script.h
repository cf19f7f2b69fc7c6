#pragma once

/// The scene's pulls as a live interaction goes through them: one after the other, on the clock of the haptic loop,
/// which stands still while the interaction is paused.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "scene/scene.h"
#include "session/scripted_pull.h"

namespace rhexis::session {

class Script {
 public:
  enum class Does { nothing, grasps, lets_go, ends };

  void begin() {
    on_ = true;
    next_ = 0;
    pulling_ = waiting_ = false;
  }
  void end() {
    on_ = pulling_ = waiting_ = false;
    next_ = 0;
    orders_ = {};
  }
  [[nodiscard]] bool is_on() const { return on_; }
  /// The pull that is made, or will be next.
  [[nodiscard]] std::size_t pull() const { return next_; }

  /// At tick `now` of the haptic loop, `passed` ticks after the last call. grasps: pull() begins, and the hand has to
  /// take hold of its point; lets_go: it is over, and after its wait the next one begins with another call, or none is
  /// left and the script is off; ends: it is off now, after the wait of the last one.
  Does step(const std::vector<scene::PullSettings>& pulls, std::uint64_t now, std::uint64_t passed, bool runs);
  /// What the device has to do after the last step.
  [[nodiscard]] const ScriptedPull& orders() const { return orders_; }

 private:
  void go_to_next(std::size_t pulls);

  bool on_ = false;
  bool pulling_ = false;
  bool waiting_ = false;  ///< after a pull
  std::size_t next_ = 0;
  std::uint64_t taken_ = 0;  ///< ticks of the present pull, or of the wait after it
  std::uint32_t pulls_ = 0;  ///< begun, by all scripts so far
  ScriptedPull orders_;
};

/// s, of all pulls, their holds and waits.
[[nodiscard]] double script_seconds(const std::vector<scene::PullSettings>& pulls);

}  // namespace rhexis::session
