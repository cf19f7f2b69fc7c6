#include "linalg/block_pool.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace rhexis::linalg {
namespace {

TEST(BlockPool, zeros_what_was_used_before) {
  for (const std::size_t count : {std::size_t{0}, std::size_t{3}, std::size_t{5000}, std::size_t{1} << 20}) {
    {
      const Block used = make_block(count);
      std::fill_n(used.get(), count, 7.0);
    }
    const Block zeroed = make_zeroed(count);
    EXPECT_TRUE(std::all_of(zeroed.get(), zeroed.get() + count, [](double x) { return x == 0.0; })) << count;
  }
}

TEST(BlockPool, hands_a_block_to_one_that_is_not_much_smaller) {
  constexpr std::size_t kCount = 300'000;
  Block first = make_block(kCount);
  const double* const at = first.get();
  first.reset();
  const Block small = make_block(kCount / 3);
  EXPECT_NE(small.get(), at);
  const Block next = make_block(kCount - kCount / 4);
  EXPECT_EQ(next.get(), at);
  const Block other = make_block(kCount);
  EXPECT_NE(other.get(), at);
}

TEST(BlockPool, keeps_a_bounded_part) {
  {
    std::vector<Block> many;
    for (int i = 0; i < 40; ++i) many.push_back(make_block((std::size_t{4} << 20) / sizeof(double)));
  }
  EXPECT_LE(idle_block_bytes(), kFewestIdleBytes);
  EXPECT_GT(idle_block_bytes(), kFewestIdleBytes / 2);
}

}  // namespace
}  // namespace rhexis::linalg
