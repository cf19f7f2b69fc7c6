#pragma once

/// How punctual the haptic loop is: written by its thread, read by any other at any time, without locks.

#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace rhexis::haptics {

/// Counts by size: bin 0 holds what is less than 1, bin k what is in [2^((k-1)/2), 2^(k/2)), the last one all above.
struct Histogram {
  static constexpr std::size_t kBins = 42;  ///< up to 2^20, a second in microseconds
  std::array<std::uint64_t, kBins> count{};

  [[nodiscard]] static std::size_t bin_of(double value) noexcept;  ///< of one that is not a number: the first
  [[nodiscard]] static double upper_edge(std::size_t bin) { return std::pow(2.0, 0.5 * static_cast<double>(bin)); }
  [[nodiscard]] std::uint64_t total() const;
  /// The part of all in bins that end at or below `value`: at least so many were smaller.
  [[nodiscard]] double part_below(double value) const;
};

/// Why a tick began late: the system woke the thread late; it took the processor away in the tick before; that tick
/// was long by itself.
enum class LateCause : std::uint8_t { none, woken_late, interrupted, own_work };

struct TickReport {
  std::uint64_t ticks = 0;
  std::uint64_t missed = 0;   ///< began more than a period after their time, or not at all
  std::uint64_t skipped = 0;  ///< periods given up after a long stop: the ticks go on, later
  std::uint64_t worst_tick = 0;
  double worst_late = 0.0;  ///< us
  LateCause worst_cause = LateCause::none;
  double worst_work = 0.0;        ///< us, the longest that a tick took by itself
  std::uint64_t oldest_tick = 0;  ///< that felt the oldest law of all
  std::uint32_t oldest = 0;       ///< ticks, its age
  Histogram late;                 ///< us after its time that a tick began
  Histogram work;                 ///< us that a tick took
  Histogram age;                  ///< ticks since the law was taken up, of the ticks that held something
};

/// The counters behind a report. One thread writes.
class TickStatistics {
 public:
  struct Tick {
    std::uint64_t number = 0;
    double late = 0.0;  ///< us
    double work = 0.0;  ///< us
    LateCause cause = LateCause::none;
    bool holds = false;
    std::uint32_t law_age = 0;
  };
  void add(const Tick& tick) noexcept;
  void add_skipped(std::uint64_t periods) noexcept {
    increase(skipped_, periods);
    increase(missed_, periods);
  }

  /// By any thread. Each number is whole; a tick may be in one and not yet in another.
  [[nodiscard]] TickReport report() const;
  /// us, the longest lateness since the last call, by one reader.
  [[nodiscard]] double take_worst() noexcept { return recent_worst_.exchange(0.0, std::memory_order_relaxed); }

 private:
  using Counter = std::atomic<std::uint64_t>;
  using Bins = std::array<Counter, Histogram::kBins>;
  static void increase(Counter& counter, std::uint64_t by) noexcept {
    counter.store(counter.load(std::memory_order_relaxed) + by, std::memory_order_relaxed);
  }

  Counter ticks_{0}, missed_{0}, skipped_{0}, worst_tick_{0}, oldest_tick_{0};
  std::atomic<std::uint32_t> oldest_{0};
  std::atomic<double> worst_late_{0.0}, worst_work_{0.0}, recent_worst_{0.0};
  std::atomic<LateCause> worst_cause_{LateCause::none};
  Bins late_{}, work_{}, age_{};
};

}  // namespace rhexis::haptics
