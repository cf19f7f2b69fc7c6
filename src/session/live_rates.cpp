#include "session/live_rates.h"

#include <algorithm>

namespace rhexis::session {
namespace {

double seconds_between(LiveRates::Clock::time_point from, LiveRates::Clock::time_point to) {
  return std::chrono::duration<double>(to - from).count();
}

}  // namespace

void LiveRates::restart() {
  const wire::RatesT shown = latest_;
  *this = LiveRates();
  latest_ = shown;
}

void LiveRates::add_step(double seconds, std::uint64_t number, std::uint64_t felt, haptics::HapticLoop& loop) {
  const Clock::time_point now = Clock::now();
  ++steps_;
  worst_ = std::max(worst_, seconds);
  // Before the one that has just been published: so old was what the loop felt.
  if (felt > 0 && number - felt < kRemembered)
    age_ = std::max(age_, seconds_between(published_[felt % kRemembered], now));
  published_[number % kRemembered] = now;
  const double passed = seconds_between(since_, now);
  if (passed < 1.0) return;
  const haptics::TickReport ticks = loop.statistics();
  latest_.physics_hz = static_cast<double>(steps_) / passed;
  latest_.physics_worst_ms = 1e3 * worst_;
  latest_.haptic_hz = static_cast<double>(ticks.ticks - ticks_before_) / passed;
  latest_.haptic_worst_us = loop.take_worst();
  latest_.haptic_missed = ticks.missed;
  latest_.snapshot_age_ms = 1e3 * age_;
  latest_.realtime = loop.is_realtime();
  since_ = now;
  steps_ = 0;
  ticks_before_ = ticks.ticks;
  worst_ = age_ = 0.0;
}

}  // namespace rhexis::session
