#include "studies/probed_device.h"

#include <sys/resource.h>

#include <algorithm>

namespace rhexis::studies {

haptics::Reading ProbedDevice::read(std::uint64_t tick) noexcept {
  const std::int64_t before = now_ns();
  const haptics::Reading reading = device_->read(tick);
  tick_ = tick;
  ticks_ = tick + 1;
  if (tick >= marks_.size()) return reading;
  rusage usage{};
  getrusage(RUSAGE_THREAD, &usage);
  marks_[tick] = {.read = before,
                  .preempted = static_cast<std::int32_t>(usage.ru_nivcsw),
                  .waited = static_cast<std::int32_t>(usage.ru_nvcsw),
                  .faults = static_cast<std::int32_t>(usage.ru_minflt + usage.ru_majflt),
                  .moved = reading.present && reading.position != position_};
  position_ = reading.position;
  return reading;
}

void ProbedDevice::write(const Vec3& force) noexcept {
  device_->write(force);
  if (tick_ >= ticks_ || tick_ >= marks_.size()) return;
  marks_[tick_].written = now_ns();
  marks_[tick_].pushed = !force.isZero(0.0);
}

std::vector<TickMark> ProbedDevice::take_marks() {
  marks_.resize(std::min<std::size_t>(marks_.size(), ticks_));
  while (!marks_.empty() && marks_.back().written == 0) marks_.pop_back();
  return std::move(marks_);
}

}  // namespace rhexis::studies
