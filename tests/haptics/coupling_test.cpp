#include "haptics/coupling.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/haptics/laws.h"

namespace rhexis::haptics::test {
namespace {

constexpr double kSpring = 1500.0;  // N/m
constexpr double kLimit = 8.9;      // N

FeltLaw random_law(std::mt19937_64& random) {
  return FeltLaw::make(random_stiffness(random), 0.01 * random_vector(random), Vec3::UnitZ(), false);
}

TEST(Coupling, BodyAndSpringPullWithTheSameForce) {
  std::mt19937_64 random(1);
  int limited = 0;
  for (int k = 0; k < 200; ++k) {
    const Mat3 stiffness = random_stiffness(random);
    const Vec3 rest = 0.01 * random_vector(random);
    const Vec3 at = 0.05 * random_vector(random);
    const Coupled got = couple(FeltLaw::make(stiffness, rest, Vec3::UnitZ(), false), at, kSpring, kLimit);
    // Eigenvectors of a 3 x 3 matrix of condition 1,000 are good to some 1e-13 of the largest entry.
    EXPECT_LT((stiffness * (got.hand - rest) - got.force).norm(), 1e-10 * kLimit);
    const Vec3 stretch = at - got.hand;
    EXPECT_LT(stretch.cross(got.force).norm(), 1e-12 * stretch.norm() * got.force.norm() + 1e-18);
    if (got.limited) {
      EXPECT_NEAR(got.force.norm(), kLimit, 1e-13 * kLimit);
      EXPECT_GT(kSpring * stretch.norm(), kLimit);
      ++limited;
    } else {
      EXPECT_LT((kSpring * stretch - got.force).norm(), 1e-12 * kLimit);
      // The slow way: (K + k) p = K r + k x.
      const Mat3 both = stiffness + kSpring * Mat3::Identity();
      EXPECT_LT((both.lu().solve(stiffness * rest + kSpring * at) - got.hand).norm(), 1e-13);
    }
  }
  EXPECT_GT(limited, 20);
  EXPECT_LT(limited, 180);
}

TEST(Coupling, TheForceIsTheSlopeOfTheEnergyLimitedOrNot) {
  std::mt19937_64 random(2);
  int limited = 0;
  for (int k = 0; k < 100; ++k) {
    const FeltLaw law = random_law(random);
    const Vec3 at = 0.05 * random_vector(random);
    const Coupled here = couple(law, at, kSpring, kLimit);
    limited += here.limited ? 1 : 0;
    for (int i = 0; i < 3; ++i) {
      const Vec3 step = 1e-6 * Vec3::Unit(i);
      const double slope =
          (couple(law, at + step, kSpring, kLimit).energy - couple(law, at - step, kSpring, kLimit).energy) / 2e-6;
      // Rounding of some 0.1 J over the step, and the second derivative's change over it.
      EXPECT_NEAR(slope, here.force[i], 1e-6 * kLimit);
    }
  }
  EXPECT_GT(limited, 10);
  EXPECT_LT(limited, 90);
}

TEST(Coupling, ARigidSpringHasTheHandAtTheDevice) {
  std::mt19937_64 random(3);
  const Mat3 stiffness = random_stiffness(random);
  const Vec3 at(0.01, -0.02, 0.005);
  const Coupled got =
      couple(FeltLaw::make(stiffness, Vec3::Zero(), Vec3::UnitZ(), false), at, std::numeric_limits<double>::infinity());
  EXPECT_EQ(got.hand, at);
  EXPECT_LT((got.force - stiffness * at).norm(), 1e-13 * got.force.norm());
  EXPECT_NEAR(got.energy, 0.5 * at.dot(stiffness * at), 1e-13 * got.energy);
}

TEST(Coupling, APushIsFeltAgainstTheNormalAlone) {
  const FeltLaw law =
      FeltLaw::make(400.0 * Vec3::UnitZ() * Vec3::UnitZ().transpose(), Vec3::Zero(), Vec3::UnitZ(), true);
  const Coupled outside = couple(law, Vec3(0.01, 0.0, 0.002), kSpring, kLimit);
  EXPECT_TRUE(outside.force.isZero(0.0));
  EXPECT_EQ(outside.hand, Vec3(0.01, 0.0, 0.002));
  EXPECT_EQ(outside.energy, 0.0);
  const Coupled inside = couple(law, Vec3(0.01, 0.0, -0.002), kSpring, kLimit);
  EXPECT_LT((inside.force - Vec3(0.0, 0.0, -0.002 / (1.0 / 400.0 + 1.0 / kSpring))).norm(), 1e-14);
  EXPECT_EQ(inside.hand[0], 0.01);
  const Coupled closed = couple(law, Vec3(0.01, 0.0, -0.002), kSpring, 0.0);
  EXPECT_TRUE(closed.force.isZero(0.0));
  EXPECT_EQ(closed.hand, Vec3(0.01, 0.0, 0.0)) << "only along the normal does the body hold the hand back";
}

TEST(Coupling, WhatIsNegativeOrNotSymmetricIsLeftOut) {
  Mat3 stiffness = Vec3(300.0, -50.0, 100.0).asDiagonal();
  stiffness(0, 1) = 20.0;
  stiffness(1, 0) = -20.0;
  const FeltLaw law = FeltLaw::make(stiffness, Vec3::Zero(), Vec3::UnitZ(), false);
  EXPECT_EQ(law.stiffness.minCoeff(), 0.0);
  EXPECT_NEAR(law.stiffness.maxCoeff(), 300.0, 1e-10);
  EXPECT_LT(couple(law, Vec3(0.0, 0.01, 0.0), kSpring).force.norm(), 1e-12);
}

TEST(Coupling, TheFeltPartIsThatOfSpringsInSeries) {
  std::mt19937_64 random(4);
  const Mat3 stiffness = random_stiffness(random);
  const FeltLaw law = FeltLaw::make(stiffness, Vec3::Zero(), Vec3::UnitZ(), false);
  const Mat3 series = (stiffness.inverse() + Mat3::Identity() / kSpring).inverse();
  EXPECT_LT((kSpring * felt_part(law, kSpring) - series).norm(), 1e-11 * series.norm());
}

}  // namespace
}  // namespace rhexis::haptics::test
