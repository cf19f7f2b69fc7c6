#include "record/store/axis.h"

#include <gmock/gmock.h>

#include <cmath>
#include <vector>

namespace rhexis::record::store {
namespace {

using testing::ElementsAre;

const std::vector<double> kAxis{0.0, 15.0, 40.0, 180.0};

TEST(Axis, WeightsAreThoseOfTheThesis) {
  for (std::size_t k = 0; k + 1 < kAxis.size(); ++k) {
    const double from = kAxis[k];
    const double to = kAxis[k + 1];
    for (const double part : {0.0, 0.1, 0.5, 0.99}) {
      const double value = from + part * (to - from);
      const Neighbours near = neighbours_on(kAxis, value);
      EXPECT_THAT(near.index, ElementsAre(static_cast<int>(k), static_cast<int>(k) + 1));
      EXPECT_EQ(near.weight[0], (to - value) / (to - from));  // (4.25)
      EXPECT_EQ(near.weight[1], (value - from) / (to - from));
      EXPECT_FALSE(near.outside);
    }
  }
}

TEST(Axis, EndsAreTakenOutsideAndSaidSo) {
  for (const auto& [value, index, outside] : {std::tuple(-0.1, 0, true), std::tuple(180.0, 3, false),
                                              std::tuple(200.0, 3, true), std::tuple(std::nan(""), 0, true)}) {
    const Neighbours near = neighbours_on(kAxis, value);
    EXPECT_EQ(near.index[0], index);
    EXPECT_THAT(near.weight, ElementsAre(1.0, 0.0));
    EXPECT_EQ(near.outside, outside);
  }
}

TEST(Axis, OneEntryHasWeightOne) {
  const std::vector<double> one{0.0403};
  EXPECT_THAT(neighbours_on(one, 0.0403).weight, ElementsAre(1.0, 0.0));
  EXPECT_FALSE(neighbours_on(one, 0.0403).outside);
  EXPECT_TRUE(neighbours_on(one, 0.05).outside);
  EXPECT_EQ(neighbours_around(std::vector<double>{0.0}, 200.0).index[0], 0);
  EXPECT_THAT(neighbours_around(std::vector<double>{0.0}, 200.0).weight, ElementsAre(1.0, 0.0));
}

TEST(Axis, PullsGoRound) {
  std::vector<double> ten;
  for (int k = 0; k < 36; ++k) ten.push_back(10.0 * k);
  for (const double value : {355.0, -5.0, 715.0, -365.0}) {
    const Neighbours near = neighbours_around(ten, value);
    EXPECT_THAT(near.index, ElementsAre(35, 0)) << value;
    EXPECT_THAT(near.weight, ElementsAre(0.5, 0.5));
    EXPECT_FALSE(near.outside);
  }
  EXPECT_THAT(neighbours_around(ten, 12.5).index, ElementsAre(1, 2));
  EXPECT_THAT(neighbours_around(ten, 12.5).weight, ElementsAre(0.75, 0.25));
  EXPECT_EQ(neighbours_around(ten, -1e-20).index[0], 0);
  EXPECT_EQ(neighbours_around(ten, 360.0).index[0], 0);
}

TEST(Axis, NearestIsTheLeastDifferenceOfAll) {
  for (double value = -20.0; value < 220.0; value += 0.7) {
    std::size_t best = 0;
    for (std::size_t k = 1; k < 4; ++k)
      if (std::abs(value - kAxis[k]) < std::abs(value - kAxis[best])) best = k;
    EXPECT_EQ(nearest_on(kAxis, value), static_cast<int>(best)) << value;
  }
  EXPECT_EQ(nearest_on(kAxis, 7.5), 0);  // of two the lower
}

}  // namespace
}  // namespace rhexis::record::store
