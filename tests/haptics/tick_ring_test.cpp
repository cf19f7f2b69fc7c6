#include "haptics/tick_ring.h"

#include <gtest/gtest.h>

#include <memory>
#include <thread>

namespace rhexis::haptics {
namespace {

TickSample sample_of(std::uint64_t tick) {
  TickSample sample;
  sample.tick = tick;
  sample.position = {1.0 * static_cast<double>(tick), 2.0 * static_cast<double>(tick), 3.0};
  return sample;
}

TEST(TickRing, GivesAllInTheirOrder) {
  const auto ring = std::make_unique<TickRing>();
  TickSample got;
  EXPECT_FALSE(ring->pop(got));
  for (std::uint64_t round = 0; round < 5; ++round) {  // past the end of the array
    for (std::uint64_t k = 0; k < 3000; ++k) EXPECT_TRUE(ring->push(sample_of(3000 * round + k)));
    for (std::uint64_t k = 0; k < 3000; ++k) {
      ASSERT_TRUE(ring->pop(got));
      EXPECT_EQ(got.tick, 3000 * round + k);
    }
  }
  EXPECT_EQ(ring->dropped(), 0u);
}

TEST(TickRing, DropsAndCountsWhatDoesNotFit) {
  const auto ring = std::make_unique<TickRing>();
  for (std::uint64_t k = 0; k < TickRing::kCapacity; ++k) EXPECT_TRUE(ring->push(sample_of(k)));
  EXPECT_FALSE(ring->push(sample_of(9)));
  EXPECT_FALSE(ring->push(sample_of(9)));
  EXPECT_EQ(ring->dropped(), 2u);
  TickSample got;
  ASSERT_TRUE(ring->pop(got));
  EXPECT_EQ(got.tick, 0u) << "the oldest are kept";
  EXPECT_TRUE(ring->push(sample_of(10)));
}

TEST(TickRing, SamplesAreWholeBetweenTwoThreads) {
  const auto ring = std::make_unique<TickRing>();
  constexpr std::uint64_t kSamples = 200'000;
  std::thread writer([&] {
    for (std::uint64_t k = 0; k < kSamples; ++k)
      while (!ring->push(sample_of(k))) std::this_thread::yield();
  });
  TickSample got;
  std::uint64_t wrong = 0;
  for (std::uint64_t k = 0; k < kSamples;) {
    if (!ring->pop(got)) {
      std::this_thread::yield();
      continue;
    }
    wrong += got.tick == k && got.position[1] == 2.0 * static_cast<double>(k) ? 0 : 1;
    ++k;
  }
  writer.join();
  EXPECT_EQ(wrong, 0u);
  EXPECT_FALSE(ring->pop(got));
}

}  // namespace
}  // namespace rhexis::haptics
