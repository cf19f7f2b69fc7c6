#pragma once

/// What the physics of a live session was at, and when: told by the frames that it sends.

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "session/frame_sink.h"

namespace rhexis::studies {

struct PhysicsEvent {
  std::int64_t at = 0;         ///< ns, when the frame was sent
  std::int64_t processor = 0;  ///< ns, of the thread of the physics until then
  wire::Payload kind = wire::Payload::NONE;
  double milliseconds = 0.0;  ///< Edit: that the advance took
};

/// Between a session and its server.
class PhysicsLog final : public session::FrameSink {
 public:
  /// Before the stream begins.
  void set(session::FrameSink& to) { to_ = &to; }
  void take(const wire::SharedMessage& message) override;
  /// Once the stream has ended.
  [[nodiscard]] std::vector<PhysicsEvent> take_events() { return std::move(events_); }

 private:
  session::FrameSink* to_ = nullptr;
  std::vector<PhysicsEvent> events_;
};

/// In words: what was under way between two moments (ns), the piece of work that ends behind the second included, and
/// how much of its time was spent on a processor.
[[nodiscard]] std::string physics_between(const std::vector<PhysicsEvent>& events, std::int64_t from, std::int64_t to);

}  // namespace rhexis::studies
