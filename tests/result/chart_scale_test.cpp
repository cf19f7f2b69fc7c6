#include "result/chart_scale.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace rhexis::result {
namespace {

using testing::ElementsAre;

/// Labels of the ticks that have one.
std::vector<std::string> labels(Scale scale, double low, double high, int wanted) {
  std::vector<std::string> out;
  for (const Tick& tick : ChartScale(scale, low, high).ticks(wanted))
    if (!tick.label.empty()) out.push_back(tick.label);
  return out;
}

TEST(ChartScale, LinearTicksAreRound) {
  EXPECT_THAT(labels(Scale::linear, 0.0, 2.0, 4), ElementsAre("0", "0.5", "1.0", "1.5", "2.0"));
  EXPECT_THAT(labels(Scale::linear, -3.7, 4.1, 4), ElementsAre("−2", "0", "2", "4"));
  EXPECT_THAT(labels(Scale::linear, 0.0, 1.0, 10),
              ElementsAre("0", "0.1", "0.2", "0.3", "0.4", "0.5", "0.6", "0.7", "0.8", "0.9", "1.0"));
  EXPECT_THAT(labels(Scale::linear, 1234.0, 1236.0, 2), ElementsAre("1234", "1235", "1236"));
}

TEST(ChartScale, LongNumbersAreGroupedAndLongerOnesGetAPower) {
  EXPECT_THAT(labels(Scale::linear, 0.0, 100000.0, 2), ElementsAre("0", "50\u2009000", "100\u2009000"));
  EXPECT_THAT(labels(Scale::linear, 0.0, 4e7, 2), ElementsAre("0", "2·10⁷", "4·10⁷"));
  EXPECT_THAT(labels(Scale::linear, -3e-5, 1e-5, 2), ElementsAre("−2·10⁻⁵", "0"));
  EXPECT_THAT(labels(Scale::linear, 0.0, 1.5e-12, 3), ElementsAre("0", "0.5·10⁻¹²", "1.0·10⁻¹²", "1.5·10⁻¹²"));
}

TEST(ChartScale, LogTicksArePowersOfTenWithLinesBetween) {
  EXPECT_THAT(labels(Scale::log, 0.5, 8000.0, 6), ElementsAre("1", "10", "100", "1000"));
  EXPECT_THAT(labels(Scale::log, 400.0, 120000.0, 8),
              ElementsAre("500", "1000", "2000", "5000", "10\u2009000", "20\u2009000", "50\u2009000", "100\u2009000"));
  EXPECT_THAT(labels(Scale::log, 1e-6, 1e-3, 3), ElementsAre("10⁻⁶", "10⁻⁵", "0.0001", "0.001"));
  const std::vector<Tick> ticks = ChartScale(Scale::log, 1.0, 100.0).ticks(2);
  ASSERT_EQ(ticks.size(), 19U);
  for (std::size_t k = 1; k < ticks.size(); ++k) EXPECT_LT(ticks[k - 1].value, ticks[k].value);
}

TEST(ChartScale, ManyDecadesAreNotLabelledOneByOne) {
  const std::vector<std::string> found = labels(Scale::log, 1e-60, 1e60, 8);
  EXPECT_GE(found.size(), 4U);
  EXPECT_LE(found.size(), 9U);
}

TEST(ChartScale, ANarrowLogAxisHasLinearTicks) {
  EXPECT_THAT(labels(Scale::log, 400.0, 800.0, 4), ElementsAre("400", "500", "600", "700", "800"));
}

TEST(ChartScale, PlacesRunFromZeroToOne) {
  const ChartScale linear(Scale::linear, -1.0, 3.0);
  EXPECT_DOUBLE_EQ(linear.place(-1.0), 0.0);
  EXPECT_DOUBLE_EQ(linear.place(1.0), 0.5);
  EXPECT_DOUBLE_EQ(linear.place(3.0), 1.0);
  const ChartScale log(Scale::log, 1.0, 10000.0);
  EXPECT_DOUBLE_EQ(log.place(1.0), 0.0);
  EXPECT_DOUBLE_EQ(log.place(100.0), 0.5);
  EXPECT_DOUBLE_EQ(log.place(10000.0), 1.0);
}

// Where all numbers are the same, or differ by rounding, the axis still has a length and a few ticks.
TEST(ChartScale, NarrowRangesAreWidened) {
  for (const double value : {0.0, 7.0, -7.0, 1e-90, 1e-200, kLargestDrawn / 2}) {
    for (const double width : {0.0, 1e-14}) {
      const ChartScale scale(Scale::linear, value, value + width * std::abs(value));
      EXPECT_LT(scale.from(), scale.to()) << value;
      EXPECT_GE(scale.place(value), 0.0);
      EXPECT_LE(scale.place(value), 1.0);
      const std::size_t ticks = scale.ticks(5).size();
      EXPECT_GE(ticks, 2U) << value;
      EXPECT_LE(ticks, 12U) << value;
    }
  }
  const ChartScale log(Scale::log, 506.0, 506.0);
  EXPECT_NEAR(log.place(506.0), 0.5, 1e-12);
  EXPECT_GE(log.ticks(5).size(), 2U);
}

TEST(ChartScale, TicksStayWithinTheAxis) {
  for (const Scale kind : {Scale::linear, Scale::log}) {
    for (double low = 1e-7; low < 1e6; low *= 3.7) {
      for (double ratio = 1.001; ratio < 1e9; ratio *= 5.3) {
        const ChartScale scale(kind, low, low * ratio);
        for (const Tick& tick : scale.ticks(7)) {
          EXPECT_GE(scale.place(tick.value), -1e-6) << low << " " << ratio;
          EXPECT_LE(scale.place(tick.value), 1.0 + 1e-6) << low << " " << ratio;
        }
        EXPECT_LE(labels(kind, low, low * ratio, 7).size(), 15U) << low << " " << ratio;
        EXPECT_GE(labels(kind, low, low * ratio, 7).size(), 1U) << low << " " << ratio;
      }
    }
  }
}

}  // namespace
}  // namespace rhexis::result
