#pragma once

/// A hand that moves by a script: straight legs, one after the other, each waited for at its end.

#include <cstdint>
#include <vector>

#include "base/vec.h"

namespace rhexis::haptics {

/// The same meaning as a pull of a scene.
struct Leg {
  Vec3 by = Vec3::Zero();  ///< m, from where the leg begins
  double seconds = 0.0;    ///< it takes
  double hold = 0.0;       ///< s, at its end
  bool lets_go = false;    ///< after it: the next leg begins at zero again, with a hold of its own
};

class Motion {
 public:
  struct Place {
    Vec3 position = Vec3::Zero();  ///< m
    std::size_t leg = 0;           ///< that it belongs to; the number of legs after the last
  };

  Motion() = default;
  explicit Motion(std::vector<Leg> legs);

  /// After `tick` ticks of the motion, 1 ms each: the same places as `rhexis tear` goes through. Behind the last leg:
  /// where that ended.
  [[nodiscard]] Place at(std::uint64_t tick) const noexcept;
  [[nodiscard]] std::uint64_t ticks() const noexcept { return ends_.empty() ? 0 : ends_.back(); }
  [[nodiscard]] const std::vector<Leg>& legs() const { return legs_; }

 private:
  std::vector<Leg> legs_;
  std::vector<std::uint64_t> moving_;  ///< ticks, of each leg, without its hold
  std::vector<std::uint64_t> ends_;    ///< tick of the motion at which each leg is over
  std::vector<Vec3> from_;             ///< m, where each begins
};

}  // namespace rhexis::haptics
