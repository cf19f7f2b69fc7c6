#include "base/hash.h"

#include <gtest/gtest.h>

#include <string_view>
#include <vector>

namespace rhexis {
namespace {

std::uint64_t hash_of(std::string_view text) { return Hash().add(std::span<const char>(text)).value(); }

// Published test vectors of 64-bit FNV-1a.
TEST(Hash, IsFnv1a) {
  EXPECT_EQ(hash_of(""), 0xcbf29ce484222325ULL);
  EXPECT_EQ(hash_of("a"), 0xaf63dc4c8601ec8cULL);
  EXPECT_EQ(hash_of("foobar"), 0x85944171f73967e8ULL);
}

TEST(Hash, PiecesHashAsTheWhole) {
  EXPECT_EQ(Hash()
                .add(std::span<const char>(std::string_view("foo")))
                .add(std::span<const char>(std::string_view("bar")))
                .value(),
            hash_of("foobar"));
}

TEST(Hash, SeesBitsThatComparisonDoesNot) {
  const std::vector<double> zero{0.0};
  const std::vector<double> minus_zero{-0.0};
  ASSERT_EQ(zero, minus_zero);
  EXPECT_NE(Hash().add(std::span<const double>(zero)).value(), Hash().add(std::span<const double>(minus_zero)).value());
}

}  // namespace
}  // namespace rhexis
