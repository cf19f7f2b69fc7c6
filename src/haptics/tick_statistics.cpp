#include "haptics/tick_statistics.h"

#include <algorithm>
#include <numeric>

#include "haptics/tick_settings.h"

namespace rhexis::haptics {
namespace {

constexpr double kPeriod = 1e6 * kTickSeconds;  // us

}  // namespace

std::size_t Histogram::bin_of(double value) noexcept {
  if (!(value >= 1.0)) return 0;
  const auto bin = static_cast<std::size_t>(std::floor(2.0 * std::log2(value))) + 1;
  return std::min(bin, kBins - 1);
}

std::uint64_t Histogram::total() const { return std::accumulate(count.begin(), count.end(), std::uint64_t{0}); }

double Histogram::part_below(double value) const {
  std::uint64_t below = 0;
  for (std::size_t bin = 0; bin + 1 < kBins && upper_edge(bin) <= value; ++bin) below += count[bin];
  const std::uint64_t all = total();
  return all == 0 ? 1.0 : static_cast<double>(below) / static_cast<double>(all);
}

void TickStatistics::add(const Tick& tick) noexcept {
  increase(ticks_, 1);
  increase(late_[Histogram::bin_of(tick.late)], 1);
  increase(work_[Histogram::bin_of(tick.work)], 1);
  if (tick.holds) increase(age_[Histogram::bin_of(tick.law_age)], 1);
  if (tick.holds && tick.law_age > oldest_.load(std::memory_order_relaxed)) {
    oldest_.store(tick.law_age, std::memory_order_relaxed);
    oldest_tick_.store(tick.number, std::memory_order_relaxed);
  }
  if (tick.late > kPeriod) increase(missed_, 1);
  if (tick.late > worst_late_.load(std::memory_order_relaxed)) {
    worst_late_.store(tick.late, std::memory_order_relaxed);
    worst_tick_.store(tick.number, std::memory_order_relaxed);
    worst_cause_.store(tick.cause, std::memory_order_relaxed);
  }
  if (tick.work > worst_work_.load(std::memory_order_relaxed)) worst_work_.store(tick.work, std::memory_order_relaxed);
  // The reader may take it away in between: then this tick begins the new count.
  double known = recent_worst_.load(std::memory_order_relaxed);
  if (tick.late > known && !recent_worst_.compare_exchange_strong(known, tick.late, std::memory_order_relaxed))
    recent_worst_.store(tick.late, std::memory_order_relaxed);
}

TickReport TickStatistics::report() const {
  const auto copy = [](const Bins& from, Histogram& to) {
    for (std::size_t bin = 0; bin < Histogram::kBins; ++bin) to.count[bin] = from[bin].load(std::memory_order_relaxed);
  };
  TickReport out;
  out.ticks = ticks_.load(std::memory_order_relaxed);
  out.missed = missed_.load(std::memory_order_relaxed);
  out.skipped = skipped_.load(std::memory_order_relaxed);
  out.worst_tick = worst_tick_.load(std::memory_order_relaxed);
  out.worst_late = worst_late_.load(std::memory_order_relaxed);
  out.worst_cause = worst_cause_.load(std::memory_order_relaxed);
  out.worst_work = worst_work_.load(std::memory_order_relaxed);
  out.oldest = oldest_.load(std::memory_order_relaxed);
  out.oldest_tick = oldest_tick_.load(std::memory_order_relaxed);
  copy(late_, out.late);
  copy(work_, out.work);
  copy(age_, out.age);
  return out;
}

}  // namespace rhexis::haptics
