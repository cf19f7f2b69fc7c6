#include "base/check.h"

#include <gtest/gtest.h>

namespace rhexis {
namespace {

TEST(CheckDeathTest, StopsWithConditionPlaceAndMessage) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const int rows = 3;
  EXPECT_DEATH(RHEXIS_CHECK(rows == 4, "rows is {}", rows),
               "rhexis: .*check_test\\.cpp:[0-9]+: internal check failed: rows == 4: rows is 3");
}

TEST(Check, EvaluatesTheConditionOnceAndTheMessageNever) {
  int conditions = 0;
  int messages = 0;
  RHEXIS_CHECK(++conditions == 1, "{}", ++messages);
  EXPECT_EQ(conditions, 1);
  EXPECT_EQ(messages, 0);
}

TEST(Check, IsOneStatement) {
  bool otherwise = false;
  if (false)
    RHEXIS_CHECK(false, "not reached");
  else
    otherwise = true;
  EXPECT_TRUE(otherwise);
}

}  // namespace
}  // namespace rhexis
