#pragma once

/// What is measured of a contestant: how soon it is at rest after a step of the hand, and how near it stays to the
/// equilibrium while the hand moves. Errors are those of the displacement of all nodes, |u - u*| / |u*|, u* the
/// converged answer of the contestant's own law; the watch stands while they are measured. It
/// counts seconds of the wall, on one thread of the processor.

#include <array>
#include <functional>
#include <memory>
#include <vector>

#include "base/vec.h"
#include "bench/rivals/contestant.h"

namespace rhexis::rivals {

using MakeContestant = std::function<std::unique_ptr<Contestant>()>;

inline constexpr std::array kErrors{0.1, 0.01, 0.001};

/// s since the hand set out; infinite where that error was not reached.
using RestTimes = std::array<double, kErrors.size()>;
/// No contestant needs more.
[[nodiscard]] RestTimes no_rest_times();

struct Rest {
  double hold = 0.0;  ///< s, until the hand has hold; what is made when the scene is opened comes before
  RestTimes reached = no_rest_times();
  double error = 1.0;  ///< at the end
};
/// The hand goes to `hand` in `moves` equal frames, and stays there until the last error is reached, or until each of
/// the errors that are not yet has taken longer than `best` has it.
[[nodiscard]] Rest race_to_rest(Contestant& contestant, const Vec3& hand, int moves, const VectorX& answer,
                                const RestTimes& best);

/// m, of the hand after `seconds` of going at `speed` (m/s) on a circle of 6 mm, down and aside.
[[nodiscard]] Vec3 circling_hand(double seconds, double speed);

/// The converged answers along the way of a hand, one every so many frames.
struct Way {
  double speed = 0.05;  ///< m/s
  int every = 5;
  std::vector<VectorX> displacement;
  std::vector<Vec3> force;  ///< N, of the hand
  [[nodiscard]] int frames() const { return every * static_cast<int>(displacement.size()); }
  [[nodiscard]] Vec3 hand(int frame) const { return circling_hand(frame * kFrame, speed); }
};

struct Following {
  double frame = 0.0;        ///< s, median
  double error = 0.0;        ///< mean over the samples
  double force_error = 0.0;  ///< the same of the force, relative to the largest
};
/// Each frame counts as 1/60 s, however long it takes. Stops, with an infinite error, where the body is lost.
[[nodiscard]] Following race_along(Contestant& contestant, const Way& way);

}  // namespace rhexis::rivals
