#include "base/error.h"

#include <gtest/gtest.h>

namespace rhexis {
namespace {

TEST(Error, MessageHasThePartsThatAreThere) {
  EXPECT_EQ((Error{"unknown key 'younf'", "did you mean 'young'?", "vessel.toml", 12}.message()),
            "vessel.toml:12: unknown key 'younf' (did you mean 'young'?)");
  EXPECT_EQ((Error{"no tets", "", "a.vtu", 0}.message()), "a.vtu: no tets");
  EXPECT_EQ((Error{"no scene given", "name one", "", 0}.message()), "no scene given (name one)");
  EXPECT_EQ((Error{"no scene given", "", "", 0}.message()), "no scene given");
}

TEST(Error, LineWithoutFileIsNotPrinted) { EXPECT_EQ((Error{"x", "", "", 7}.message()), "x"); }

TEST(Error, AtPlacesAnErrorOnce) {
  const Error nowhere{"set 'top' holds no node", "enlarge its box", "", 0};
  const Error placed = nowhere.at("scene.toml", 4);
  EXPECT_EQ(placed.message(), "scene.toml:4: set 'top' holds no node (enlarge its box)");
  EXPECT_EQ(placed.at("other.toml", 9).message(), placed.message());
  EXPECT_TRUE(nowhere.file.empty());
}

TEST(Error, FailBecomesAnUnexpectedOfAnyType) {
  const auto half = [](int n) -> Expected<int> {
    if (n % 2 != 0) return fail("odd", "give an even number", "numbers", 3);
    return n / 2;
  };
  ASSERT_TRUE(half(4).has_value());
  EXPECT_EQ(*half(4), 2);
  const Expected<int> odd = half(5);
  ASSERT_FALSE(odd.has_value());
  EXPECT_EQ(odd.error().message(), "numbers:3: odd (give an even number)");

  const auto pass_on = [&](int n) -> Expected<std::string> {
    const Expected<int> value = half(n);
    if (!value) return fail(value.error().at("elsewhere"));
    return std::to_string(*value);
  };
  EXPECT_EQ(pass_on(5).error().message(), odd.error().message());
}

}  // namespace
}  // namespace rhexis
