#include "bench/rivals/race.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/clock.h"
#include "base/parallel.h"
#include "bench/processor_watch.h"

namespace rhexis::rivals {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kLost = 3.0;  ///< an error above which a body does not come back
constexpr double kRadius = 0.006;

/// Of the wall; on one thread of the processor, so that what else runs on the machine counts little.
class RaceWatch {
 public:
  [[nodiscard]] double seconds() const { return thread_count() == 1 ? processor_.seconds() : wall_.seconds(); }

 private:
  Stopwatch wall_;
  ProcessorWatch processor_;
};

}  // namespace

RestTimes no_rest_times() {
  RestTimes out;
  out.fill(kInfinite);
  return out;
}

Rest race_to_rest(Contestant& contestant, const Vec3& hand, int moves, const VectorX& answer, const RestTimes& best) {
  Rest out;
  const RaceWatch holding;
  contestant.hold();
  out.hold = holding.seconds();
  double seconds = 0.0;
  std::size_t next = 0;
  for (int frame = 1; next < kErrors.size() &&
                      seconds < *std::max_element(best.begin() + static_cast<std::ptrdiff_t>(next), best.end());
       ++frame) {
    const double part = std::min(1.0, static_cast<double>(frame) / moves);
    const RaceWatch watch;
    contestant.frame(part * hand);
    seconds += watch.seconds();
    if (frame < moves) continue;
    out.error = error_of(contestant.displacement(), answer);
    if (!(out.error < kLost)) break;
    while (next < kErrors.size() && out.error < kErrors[next]) out.reached[next++] = seconds;
  }
  return out;
}

Vec3 circling_hand(double seconds, double speed) {
  const double angle = speed * seconds / kRadius;
  return {0.0, kRadius * std::sin(angle), -kRadius * (1.0 - std::cos(angle))};
}

Following race_along(Contestant& contestant, const Way& way) {
  contestant.hold();
  std::vector<double> seconds;
  Following out;
  double largest = 0.0;
  for (const Vec3& force : way.force) largest = std::max(largest, force.norm());
  const auto samples = static_cast<double>(way.displacement.size());
  for (int frame = 1; frame <= way.frames(); ++frame) {
    const RaceWatch watch;
    contestant.frame(way.hand(frame));
    seconds.push_back(watch.seconds());
    if (frame % way.every != 0) continue;
    const auto sample = static_cast<std::size_t>(frame / way.every - 1);
    const double error = error_of(contestant.displacement(), way.displacement[sample]);
    out.error += error / samples;
    out.force_error += (contestant.force() - way.force[sample]).norm() / largest / samples;
    if (!(error < kLost)) {
      out.error = out.force_error = kInfinite;
      break;
    }
  }
  const auto middle = seconds.begin() + static_cast<std::ptrdiff_t>(seconds.size() / 2);
  std::nth_element(seconds.begin(), middle, seconds.end());
  out.frame = *middle;
  return out;
}

}  // namespace rhexis::rivals
