#include "base/parallel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

namespace rhexis {
namespace {

/// Leaves the thread count as it found it.
class Parallel : public testing::TestWithParam<int> {
 protected:
  Parallel() { set_thread_count(GetParam()); }
  ~Parallel() override { set_thread_count(0); }
};

INSTANTIATE_TEST_SUITE_P(Threads, Parallel, testing::Values(1, 2, 3, 8), testing::PrintToStringParamName());

using Range = std::pair<std::size_t, std::size_t>;

std::vector<Range> ranges(std::size_t count, std::size_t grain) {
  std::mutex mutex;
  std::vector<Range> seen;
  parallel_ranges(count, grain, [&](std::size_t begin, std::size_t end) {
    const std::scoped_lock lock(mutex);
    seen.emplace_back(begin, end);
  });
  std::sort(seen.begin(), seen.end());
  return seen;
}

TEST_P(Parallel, VisitsEveryIndexOnce) {
  for (const std::size_t count : {0U, 1U, 2U, 7U, 1000U}) {
    std::vector<std::atomic<int>> visits(count);
    parallel_for(count, [&](std::size_t i) { ++visits[i]; });
    EXPECT_TRUE(std::all_of(visits.begin(), visits.end(), [](const auto& n) { return n == 1; })) << count;
  }
}

TEST_P(Parallel, RangesDependOnCountAndGrainAlone) {
  EXPECT_EQ(ranges(10, 4), (std::vector<Range>{{0, 4}, {4, 8}, {8, 10}}));
  EXPECT_EQ(ranges(8, 4), (std::vector<Range>{{0, 4}, {4, 8}}));
  EXPECT_EQ(ranges(3, 100), (std::vector<Range>{{0, 3}}));
  EXPECT_TRUE(ranges(0, 4).empty());
}

// What the house relies on: partial sums per range, added in the order of the ranges, are the same bits.
TEST_P(Parallel, SumsByRangesHaveTheBitsOfOneThread) {
  constexpr std::size_t kCount = 10007;
  constexpr std::size_t kGrain = 64;
  const auto sum = [&] {
    std::vector<double> partial((kCount + kGrain - 1) / kGrain);
    parallel_ranges(kCount, kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) partial[begin / kGrain] += std::sin(static_cast<double>(i));
    });
    double total = 0.0;
    for (const double p : partial) total += p;
    return total;
  };
  const double here = sum();
  set_thread_count(1);
  EXPECT_EQ(here, sum());
}

TEST_P(Parallel, NestedLoopsFinish) {
  std::atomic<int> visits = 0;
  parallel_for(8, [&](std::size_t) { parallel_for(8, [&](std::size_t) { ++visits; }); });
  EXPECT_EQ(visits, 64);
}

TEST_P(Parallel, ExceptionReachesTheCaller) {
  EXPECT_THROW(parallel_for(100,
                            [](std::size_t i) {
                              if (i == 57) throw std::runtime_error("57");
                            }),
               std::runtime_error);
  EXPECT_EQ(ranges(10, 10).size(), 1U);  // and the pool works on
}

// More threads than cores come when they are asked for: else the tests of determinism would compare a run with itself.
void expect_threads(std::size_t threads) {
  std::atomic<std::size_t> arrived = 0;
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(10);
  parallel_for(threads, [&](std::size_t) {
    ++arrived;
    while (arrived < threads && std::chrono::steady_clock::now() < deadline) std::this_thread::yield();
  });
  EXPECT_LT(std::chrono::steady_clock::now(), deadline);
}

TEST_P(Parallel, ThreadsAreThere) { expect_threads(static_cast<std::size_t>(GetParam())); }

TEST_P(Parallel, OnOneThreadHereAndOnAllAgainAfterwards) {
  const std::thread::id here = std::this_thread::get_id();
  {
    const OneThreadHere outer;
    { const OneThreadHere inner; }
    std::atomic<bool> all = true;
    parallel_for(1000, [&](std::size_t) { all = all && std::this_thread::get_id() == here; });
    EXPECT_TRUE(all);
  }
  expect_threads(static_cast<std::size_t>(GetParam()));
}

TEST_P(Parallel, CountIsAsSet) { EXPECT_EQ(thread_count(), GetParam()); }

TEST(ThreadCount, ZeroAsksForAllCores) {
  set_thread_count(0);
  EXPECT_GE(thread_count(), 1);
  EXPECT_LE(thread_count(), static_cast<int>(std::thread::hardware_concurrency()));
}

TEST(ParallelDeathTest, GrainOfZero) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_DEATH(parallel_ranges(3, 0, [](std::size_t, std::size_t) {}), "grain is 0");
}

}  // namespace
}  // namespace rhexis
