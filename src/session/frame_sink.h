#pragma once

/// Both ends of an interaction that runs: where its frames go, and where what is asked of it comes in.

#include "wire/frame.h"

namespace rhexis::session {

/// Takes the stream of an interaction, in its order: a live view, a recording.
class FrameSink {
 public:
  virtual ~FrameSink() = default;
  /// On the thread of the physics: must not wait.
  virtual void take(const wire::SharedMessage& message) = 0;
};

/// What clients talk to: an interaction that runs, or a recording that is played.
class CommandTarget {
 public:
  virtual ~CommandTarget() = default;
  /// From any thread; carried out in the order of the calls. What makes no sense is answered by a Notice.
  virtual void post(wire::PayloadUnion command) = 0;
  /// A Hello: the first frame of a client.
  [[nodiscard]] virtual wire::SharedMessage hello() const = 0;
};

}  // namespace rhexis::session
