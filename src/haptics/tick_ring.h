#pragma once

/// All ticks, one after the other, from the haptic loop to whoever records or shows them.

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace rhexis::haptics {

/// One tick: what went into it, from which it can be computed again, and what came out.
struct TickSample {
  std::uint64_t tick = 0;
  std::uint64_t number = 0;          ///< of the snapshot that was in force
  std::array<double, 3> position{};  ///< m, as the device gave it
  std::uint32_t buttons = 0;         ///< as the device gave them
  std::uint8_t present = 0;          ///< as the device gave it, 0 or 1
  std::uint8_t fresh = 0;            ///< 1: the snapshot was taken up in this tick
  std::uint16_t late = 0;            ///< us after its time that the tick began; the most that fits when more
  std::uint32_t grasp = 0;           ///< as HandState
  std::uint32_t flags = 0;           ///< as HandState
  std::array<double, 3> hand{};      ///< m, as HandState
  std::array<double, 3> force{};     ///< N, as HandState
};
static_assert(std::is_trivially_copyable_v<TickSample>);

/// From one thread to one other, wait-free, of fixed size. What does not fit is dropped and counted: the haptic loop
/// waits for nobody.
class TickRing {
 public:
  static constexpr std::size_t kCapacity = 8192;  ///< samples; at 1 kHz the reader may be away for eight seconds

  TickRing() = default;
  TickRing(const TickRing&) = delete;
  TickRing& operator=(const TickRing&) = delete;

  /// By the one writer. False: it was full.
  bool push(const TickSample& sample) noexcept {
    const std::uint64_t end = end_.load(std::memory_order_relaxed);
    if (end - begin_.load(std::memory_order_acquire) == kCapacity) {
      dropped_.store(dropped_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
      return false;
    }
    samples_[end % kCapacity] = sample;
    end_.store(end + 1, std::memory_order_release);
    return true;
  }

  /// By the one reader: the oldest. False: there is none.
  bool pop(TickSample& sample) noexcept {
    const std::uint64_t begin = begin_.load(std::memory_order_relaxed);
    if (begin == end_.load(std::memory_order_acquire)) return false;
    sample = samples_[begin % kCapacity];
    begin_.store(begin + 1, std::memory_order_release);
    return true;
  }

  /// How many have been dropped, by any thread.
  [[nodiscard]] std::uint64_t dropped() const noexcept { return dropped_.load(std::memory_order_relaxed); }

 private:
  std::array<TickSample, kCapacity> samples_{};
  alignas(64) std::atomic<std::uint64_t> end_{0};    ///< the writer's
  alignas(64) std::atomic<std::uint64_t> begin_{0};  ///< the reader's
  alignas(64) std::atomic<std::uint64_t> dropped_{0};
};

}  // namespace rhexis::haptics
