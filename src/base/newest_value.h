#pragma once

/// The newest of the values that one thread publishes, for one other thread: wait-free on both sides, whole, and
/// without memory. Three slots: one is written, one is read, one lies between.

#include <array>
#include <atomic>
#include <cstdint>
#include <type_traits>

namespace rhexis {

template <typename T>
class NewestValue {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  NewestValue() = default;
  NewestValue(const NewestValue&) = delete;
  NewestValue& operator=(const NewestValue&) = delete;

  /// By the one writer.
  void publish(const T& value) noexcept {
    slots_[written_].value = value;
    written_ = between_.exchange(written_ | kFresh, std::memory_order_acq_rel) & kSlot;
  }

  /// By the one reader: takes the newest value up, if there is one since the last call. True: there was.
  bool take(T& value) noexcept {
    if ((between_.load(std::memory_order_relaxed) & kFresh) == 0) return false;
    read_ = between_.exchange(read_, std::memory_order_acq_rel) & kSlot;
    value = slots_[read_].value;
    return true;
  }

 private:
  static constexpr std::uint32_t kSlot = 3;
  static constexpr std::uint32_t kFresh = 4;
  struct alignas(64) Slot {
    T value{};
  };
  std::array<Slot, 3> slots_;
  alignas(64) std::uint32_t written_ = 0;  ///< the writer's
  alignas(64) std::uint32_t read_ = 1;     ///< the reader's
  alignas(64) std::atomic<std::uint32_t> between_ = 2;
};

}  // namespace rhexis
