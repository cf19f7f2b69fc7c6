#pragma once

/// What a live session is for, where that is more than free play: an experiment chooses the body that is seen, binds
/// the hand to a point and a direction, and says what is felt.

#include <memory>

#include "base/error.h"
#include "response/contact.h"
#include "session/open_body.h"
#include "wire/frame.h"

namespace rhexis::session {

/// Called by the thread of the physics, but for open().
class LiveTask {
 public:
  virtual ~LiveTask() = default;

  /// The body that is seen. Called once, before all else.
  virtual Expected<std::unique_ptr<OpenBody>> open() = 0;
  /// A Feel or an Answer. The hand has let go then, and what follows may be another. Errors: it makes no sense now, or
  /// could not be kept, and all stays as it was; or it was kept, and there is nothing to go on with.
  virtual Expected<void> carry_out(const wire::PayloadUnion& command) = 0;
  /// The hand has taken hold, of what felt() is the law of.
  virtual void has_hold() = 0;

  /// In place of the law of the body that is seen.
  [[nodiscard]] virtual const response::ContactLaw& felt() const = 0;
  /// What clients are shown: `point` and `direction` also bind the hand. `shows_force` is left to the session.
  [[nodiscard]] virtual wire::TrialT show() const = 0;
};

}  // namespace rhexis::session
