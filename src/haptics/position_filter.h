#pragma once

/// Where a device that tells its position in steps has most likely been between them: for the energy, not for the
/// force. A motion that is slow beside a step a tick is read as rests and jumps. A spring seems to give out k step^2 /
/// 2 in each of those, and no damper to take anything, so that the force of a hand that trembles would be given away.
/// So the motion is followed at its mean speed (an alpha-beta filter), never further from what was read than half a
/// step: within that nobody knows where the device is. The force is that of the reading, since a filter in the loop
/// would be a delay in it.

#include <algorithm>

#include "base/vec.h"

namespace rhexis::haptics {

class PositionFilter {
 public:
  /// `resolution`: m, of the device; 0: what is read is passed on.
  explicit PositionFilter(double resolution) : half_step_(0.5 * resolution) {}

  /// Begins at rest.
  Vec3 restart(const Vec3& reading) noexcept {
    change_.setZero();
    return position_ = reading;
  }

  /// Once a tick.
  Vec3 follow(const Vec3& reading) noexcept {
    const Vec3 expected = position_ + change_;
    const Vec3 error = reading - expected;
    change_ += kOfChange * error;
    for (int i = 0; i < 3; ++i) {
      const double between = expected[i] + kOfPosition * error[i];
      position_[i] = std::clamp(between, reading[i] - half_step_, reading[i] + half_step_);
    }
    return position_;
  }

 private:
  /// Of a new reading. The second makes the filter settle without swinging, a^2 / (2 - a), in some ten ticks.
  static constexpr double kOfPosition = 0.2;
  static constexpr double kOfChange = kOfPosition * kOfPosition / (2.0 - kOfPosition);

  double half_step_;              ///< m
  Vec3 position_ = Vec3::Zero();  ///< m
  Vec3 change_ = Vec3::Zero();    ///< m, in a tick
};

}  // namespace rhexis::haptics
