#pragma once

/// From a scene to a session that is ready to be pulled at: what `rhexis tear` and `rhexis play`
/// begin with and `rhexis check` tries.

#include <memory>
#include <string>
#include <vector>

#include "scene/tear_problem.h"
#include "session/tear_session.h"

namespace rhexis::session {

struct TearStart {
  response::SharedRecord record;  ///< of `response = "recorded"`; else null
  std::unique_ptr<TearSession> tear;
  std::vector<std::string> warnings;  ///< one line each, placed
};

/// Who goes on when a body of large strain is a few frames behind the hand.
enum class Pace {
  waits,      ///< a script: a tick ends when the body is in equilibrium
  goes_along  ///< somebody who holds it: a tick is a frame
};

/// Reads the record that the scene's response needs, unless `record` is it; cuts the first cracks, factors, and takes
/// hold of the point of every pull once. Errors are placed; those of the record as load_record.
[[nodiscard]] Expected<TearStart> start_tear(const scene::TearProblem& problem, response::SharedRecord record = nullptr,
                                             Pace pace = Pace::waits);

}  // namespace rhexis::session
