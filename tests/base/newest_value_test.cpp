#include "base/newest_value.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <thread>

namespace rhexis::test {
namespace {

/// Large enough that a copy is not one instruction; whole when all words are the same.
struct Words {
  std::array<std::uint64_t, 40> word{};
  [[nodiscard]] bool is_whole() const {
    for (const std::uint64_t each : word)
      if (each != word.front()) return false;
    return true;
  }
};

TEST(NewestValue, IsTakenOnceAndIsTheNewest) {
  NewestValue<int> newest;
  int value = -1;
  EXPECT_FALSE(newest.take(value));
  EXPECT_EQ(value, -1);
  newest.publish(1);
  newest.publish(2);
  newest.publish(3);
  EXPECT_TRUE(newest.take(value));
  EXPECT_EQ(value, 3);
  EXPECT_FALSE(newest.take(value));
  newest.publish(4);
  EXPECT_TRUE(newest.take(value));
  EXPECT_EQ(value, 4);
}

TEST(NewestValue, ValuesAreWholeAndInOrderBetweenTwoThreads) {
  constexpr std::uint64_t kValues = 300'000;
  NewestValue<Words> newest;
  std::atomic<bool> done{false};
  std::thread writer([&] {
    Words words;
    for (std::uint64_t k = 1; k <= kValues; ++k) {
      words.word.fill(k);
      newest.publish(words);
      if (k % 1000 == 0) std::this_thread::yield();  // on one core too both get their turn
    }
    done = true;
  });
  Words seen;
  std::uint64_t last = 0;
  std::uint64_t taken = 0;
  std::uint64_t torn = 0;
  std::uint64_t old = 0;
  bool is_last_look = false;
  while (!is_last_look) {
    is_last_look = done;  // before the take: what was published before it is seen by it
    if (!newest.take(seen)) continue;
    ++taken;
    torn += seen.is_whole() ? 0 : 1;
    old += seen.word.front() > last ? 0 : 1;
    last = seen.word.front();
  }
  writer.join();
  EXPECT_EQ(torn, 0u);
  EXPECT_EQ(old, 0u) << "none twice, none after a newer one";
  EXPECT_EQ(last, kValues) << "the last one is not lost";
  EXPECT_GT(taken, 10u);
}

}  // namespace
}  // namespace rhexis::test
