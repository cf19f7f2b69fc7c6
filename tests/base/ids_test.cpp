#include "base/ids.h"

#include <gtest/gtest.h>

#include <type_traits>
#include <unordered_set>

namespace rhexis {
namespace {

// The point of typed ids is what does not compile.
static_assert(!std::is_convertible_v<NodeId, TetId>);
static_assert(!std::is_constructible_v<NodeId, TetId>);
static_assert(!std::is_convertible_v<int, NodeId>);
static_assert(!std::is_convertible_v<NodeId, int>);
static_assert(sizeof(NodeId) == 4 && std::is_trivially_copyable_v<NodeId>);

TEST(Ids, DefaultIsInvalid) {
  EXPECT_FALSE(NodeId().valid());
  EXPECT_TRUE(NodeId(0).valid());
}

TEST(Ids, ValueAndIndexAgree) {
  const TetId last(std::size_t{2147483647});
  EXPECT_EQ(last.value(), 2147483647);
  EXPECT_EQ(last.index(), 2147483647U);
}

TEST(Ids, OrderIsThatOfTheIntegers) {
  EXPECT_LT(NodeId(3), NodeId(4));
  EXPECT_EQ(NodeId(3), NodeId(3));
  EXPECT_NE(NodeId(3), NodeId());
}

TEST(Ids, AreKeysOfHashedSets) {
  const std::unordered_set<NodeId> seen{NodeId(1), NodeId(2), NodeId(1)};
  EXPECT_EQ(seen.size(), 2U);
  EXPECT_TRUE(seen.contains(NodeId(2)));
  EXPECT_FALSE(seen.contains(NodeId(3)));
}

}  // namespace
}  // namespace rhexis
