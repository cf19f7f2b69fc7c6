#pragma once

/// What waits for somebody who is slower than the interaction: all frames in order, but of the States the newest alone.

#include <cstddef>
#include <deque>

#include "wire/frame.h"

namespace rhexis::server {

class FrameQueue {
 public:
  /// A State takes the place of the one that waits, but stands behind every frame that came before it.
  void push(const wire::SharedMessage& message);
  /// The next one; null when none waits.
  [[nodiscard]] wire::SharedMessage pop();

  [[nodiscard]] bool empty() const { return kept_.empty() && state_ == nullptr; }
  /// Of the frames that must arrive.
  [[nodiscard]] std::size_t kept_frames() const { return kept_.size(); }
  [[nodiscard]] std::size_t kept_bytes() const { return kept_bytes_; }

 private:
  std::deque<wire::SharedMessage> kept_;
  std::size_t kept_bytes_ = 0;
  wire::SharedMessage state_;     ///< null: none waits
  std::size_t before_state_ = 0;  ///< frames of kept_ that go first
};

}  // namespace rhexis::server
