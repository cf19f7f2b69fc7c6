#pragma once

#include <algorithm>
#include <chrono>

namespace rhexis::server {

/// So many a second in the long run, and so many at once.
class RateLimit {
 public:
  using Clock = std::chrono::steady_clock;

  RateLimit(double per_second, double at_once, Clock::time_point now)
      : per_second_(per_second), at_once_(at_once), left_(at_once), seen_(now) {}

  /// Counts one, and says how long to wait before the next.
  [[nodiscard]] Clock::duration count(Clock::time_point now) {
    left_ = std::min(at_once_, left_ + per_second_ * std::chrono::duration<double>(now - seen_).count()) - 1.0;
    seen_ = now;
    if (left_ >= 0.0) return Clock::duration::zero();
    return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(-left_ / per_second_));
  }

 private:
  double per_second_;
  double at_once_;
  double left_;
  Clock::time_point seen_;
};

}  // namespace rhexis::server
