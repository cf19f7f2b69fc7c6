#include "haptics/motion.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "haptics/tick_settings.h"

namespace rhexis::haptics {
namespace {

std::uint64_t ticks_of(double seconds) {
  return static_cast<std::uint64_t>(std::max(0L, std::lround(seconds / kTickSeconds)));
}

}  // namespace

Motion::Motion(std::vector<Leg> legs) : legs_(std::move(legs)) {
  Vec3 from = Vec3::Zero();
  std::uint64_t end = 0;
  for (const Leg& leg : legs_) {
    moving_.push_back(std::max<std::uint64_t>(1, ticks_of(leg.seconds)));
    end += moving_.back() + ticks_of(leg.hold);
    ends_.push_back(end);
    from_.push_back(from);
    from += leg.by;
  }
}

HandPlace Motion::at(std::uint64_t tick) noexcept {
  HandPlace out;
  if (legs_.empty()) return out;
  const auto found = std::lower_bound(ends_.begin(), ends_.end(), tick);
  const std::size_t at = std::min(static_cast<std::size_t>(found - ends_.begin()), legs_.size() - 1);
  const std::uint64_t begin = at == 0 ? 0 : ends_[at - 1];
  const std::uint64_t moved = std::min(tick - begin, moving_[at]);
  out.hold = tick <= ticks() ? 1 : 0;
  out.position = from_[at] + legs_[at].by * (static_cast<double>(moved) / static_cast<double>(moving_[at]));
  return out;
}

}  // namespace rhexis::haptics
