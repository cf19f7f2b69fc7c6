#include "haptics/position_filter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace rhexis::haptics {
namespace {

constexpr double kStep = 6e-5;  // m

Vec3 read(const Vec3& position) {
  Vec3 out;
  for (int i = 0; i < 3; ++i) out[i] = kStep * std::round(position[i] / kStep);
  return out;
}

TEST(PositionFilter, WithoutStepsPassesOnWhatIsRead) {
  PositionFilter filter(0.0);
  EXPECT_EQ(filter.restart(Vec3(1.0, 2.0, 3.0)), Vec3(1.0, 2.0, 3.0));
  for (int k = 0; k < 100; ++k) {
    const Vec3 reading(std::sin(k), 0.1 * k, k % 2);
    EXPECT_EQ(filter.follow(reading), reading);
  }
}

TEST(PositionFilter, StaysWithinHalfAStepAndIsSmootherThanTheSteps) {
  PositionFilter filter(kStep);
  const auto place = [](int t) {
    const double turn = 2.0 * std::numbers::pi * 1e-3 * t;
    return Vec3(0.02 * std::sin(turn), 5e-4 * std::sin(8.0 * turn), 1e-5 * t);
  };
  Vec3 last = filter.restart(read(place(0)));
  Vec3 last_reading = read(place(0));
  double squares = 0.0;
  double squares_read = 0.0;
  for (int t = 1; t < 2000; ++t) {
    const Vec3 reading = read(place(t));
    const Vec3 seen = filter.follow(reading);
    EXPECT_LE((seen - reading).cwiseAbs().maxCoeff(), 0.5 * kStep * (1.0 + 1e-9));
    squares += (seen - last - (place(t) - place(t - 1))).squaredNorm();
    squares_read += (reading - last_reading - (place(t) - place(t - 1))).squaredNorm();
    last = seen;
    last_reading = reading;
  }
  EXPECT_LT(squares, 0.2 * squares_read) << "of what a tick's motion is wrong by";
}

}  // namespace
}  // namespace rhexis::haptics
