#pragma once

/// A hand that moves in straight legs, one after the other, each waited for at its end: tests and measurements.

#include <cstdint>
#include <vector>

#include "haptics/hand_path.h"

namespace rhexis::haptics {

struct Leg {
  Vec3 by = Vec3::Zero();  ///< m, from where the leg begins
  double seconds = 0.0;    ///< it takes
  double hold = 0.0;       ///< s, at its end
};

class Motion final : public HandPath {
 public:
  Motion() = default;
  explicit Motion(std::vector<Leg> legs);

  /// One hold, from tick 0 until the last leg is over; then where that ended.
  HandPlace at(std::uint64_t tick) noexcept override;
  [[nodiscard]] std::uint64_t ticks() const noexcept { return ends_.empty() ? 0 : ends_.back(); }

 private:
  std::vector<Leg> legs_;
  std::vector<std::uint64_t> moving_;  ///< ticks, of each leg, without its hold
  std::vector<std::uint64_t> ends_;    ///< tick of the motion at which each leg is over
  std::vector<Vec3> from_;             ///< m, where each begins
};

}  // namespace rhexis::haptics
