#include "mesh/nearest.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace rhexis::mesh {
namespace {

using Corners = std::array<Vec3, 3>;

/// By going through a fine lattice of area coordinates.
double slow_distance(const Corners& corner, const Vec3& at, int steps) {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= steps; ++i)
    for (int j = 0; i + j <= steps; ++j) {
      const Vec3 x = (i * corner[0] + j * corner[1] + (steps - i - j) * corner[2]) / steps;
      least = std::min(least, (x - at).norm());
    }
  return least;
}

TEST(NearestInTriangle, IsNearerThanEveryOtherPointOfIt) {
  std::mt19937_64 random(3);
  const auto vector = [&] {
    Vec3 v;
    for (int c = 0; c < 3; ++c) v[c] = static_cast<double>(random() >> 11) * 0x1p-52 - 1.0;
    return v;
  };
  constexpr int kSteps = 60;
  int inside = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const Corners corner{vector(), vector(), vector()};
    const Vec3 at = 1.5 * vector();
    const TrianglePoint found = nearest_in_triangle(corner, at);
    const double distance = (found.position - at).norm();
    const double slow = slow_distance(corner, at, kSteps);
    EXPECT_LE(distance, slow + 1e-15);
    EXPECT_GT(distance, slow - 4.0 / kSteps);  // a step along the longest side
    const Vec3 of_weights = found.weight[0] * corner[0] + found.weight[1] * corner[1] + found.weight[2] * corner[2];
    // Area coordinates of a sliver are as inexact as it is long for its height.
    EXPECT_LT((of_weights - found.position).norm(), 1e-11);
    EXPECT_NEAR(found.weight.sum(), 1.0, 1e-15);
    EXPECT_GE(found.weight.minCoeff(), 0.0);
    inside += found.weight.minCoeff() > 0.0 ? 1 : 0;
  }
  EXPECT_GT(inside, 10);
  EXPECT_LT(inside, 280);
}

TEST(NearestInTriangle, CornersAndSidesAreMetToTheBit) {
  const Corners corner{Vec3(0.1, 0.2, 0.3), Vec3(1.3, 0.1, 0.2), Vec3(0.4, 1.7, 0.6)};
  for (std::size_t k = 0; k < 3; ++k) {
    const TrianglePoint at_corner = nearest_in_triangle(
        corner, corner[k] + 0.1 * (corner[k] - corner[(k + 1) % 3]) + 0.1 * (corner[k] - corner[(k + 2) % 3]));
    EXPECT_EQ(at_corner.weight, Vec3(Vec3::Unit(static_cast<Eigen::Index>(k))));
    EXPECT_LT((at_corner.position - corner[k]).norm(), 1e-15);
    const Vec3& a = corner[(k + 1) % 3];
    const Vec3& b = corner[(k + 2) % 3];
    const TrianglePoint beside = nearest_in_triangle(corner, 0.5 * (a + b) + 0.3 * (0.5 * (a + b) - corner[k]));
    EXPECT_EQ(beside.weight[static_cast<Eigen::Index>(k)], 0.0);
    EXPECT_LT((nearest_on_segment(a, b, beside.position) - beside.position).norm(), 1e-15);
  }
}

TEST(NearestInTriangle, WithoutAnAreaIsASegmentOrAPoint) {
  const Vec3 a(0, 0, 0), b(1, 0, 0), c(2, 0, 0);
  EXPECT_EQ(nearest_in_triangle({a, b, c}, Vec3(1.5, 1, 0)).position, Vec3(1.5, 0, 0));
  EXPECT_EQ(nearest_in_triangle({a, c, b}, Vec3(3, 1, 0)).position, c);
  EXPECT_EQ(nearest_in_triangle({b, b, b}, Vec3(3, 1, 0)).position, b);
  EXPECT_EQ(nearest_on_segment(b, b, a), b);
}

}  // namespace
}  // namespace rhexis::mesh
