#include "base/nearest_name.h"

#include <gtest/gtest.h>

#include <vector>

namespace rhexis {
namespace {

const std::vector<std::string> kKeys{"young", "poisson", "density", "law", "c1", "c2", "kappa"};

TEST(NearestName, FindsSlipsOfTheHand) {
  EXPECT_EQ(nearest_name("younf", kKeys), "young");     // a wrong letter
  EXPECT_EQ(nearest_name("yuong", kKeys), "young");     // two swapped
  EXPECT_EQ(nearest_name("poison", kKeys), "poisson");  // one missing
  EXPECT_EQ(nearest_name("densityy", kKeys), "density");
  EXPECT_EQ(nearest_name("law", kKeys), "law");
}

TEST(NearestName, LongNamesMayBeFurtherOff) {
  const std::vector<std::string> models{"geometrically-nonlinear", "hyperelastic"};
  EXPECT_EQ(nearest_name("geometric-nonlinear", models), "geometrically-nonlinear");  // four letters missing
}

TEST(NearestName, SaysNothingWhenNothingIsNear) {
  EXPECT_EQ(nearest_name("temperature", kKeys), "");
  EXPECT_EQ(nearest_name("young", std::vector<std::string>{}), "");
}

TEST(NearestName, OfEquallyNearOnesTheFirst) { EXPECT_EQ(nearest_name("c3", kKeys), "c1"); }

}  // namespace
}  // namespace rhexis
