#include "fracture/tet_stress.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "tests/fracture/stress_fields.h"

namespace rhexis::fracture::test {
namespace {

void expect_decomposes(const Mat3& stress, double scale) {
  const PrincipalStress principal = principal_stress(stress);
  EXPECT_GE(principal.value[0], principal.value[1]);
  EXPECT_GE(principal.value[1], principal.value[2]);
  // The solver's backward error: some operations of 2^-53 on entries of that scale.
  EXPECT_LT((principal.axes.transpose() * principal.axes - Mat3::Identity()).cwiseAbs().maxCoeff(), 1e-14);
  EXPECT_NEAR(principal.axes.determinant(), 1.0, 1e-14);
  const Vec3 values(principal.value[0], principal.value[1], principal.value[2]);
  EXPECT_LE((principal.axes * values.asDiagonal() * principal.axes.transpose() - stress).cwiseAbs().maxCoeff(),
            1e-14 * scale);
}

TEST(PrincipalStress, OfAnyStress) {
  std::mt19937_64 random(5);
  for (int trial = 0; trial < 200; ++trial) {
    Mat3 any;
    for (int i = 0; i < 9; ++i) any(i / 3, i % 3) = 1e6 * (uniform(random) - 0.5);
    expect_decomposes(any + any.transpose(), 1e6);
  }
}

TEST(PrincipalStress, OfStressesAlike) {
  const Mat3 Q = Eigen::AngleAxisd(1.1, Vec3(0.3, -1.0, 0.5).normalized()).toRotationMatrix();
  for (const Vec3& values : {Vec3(0.0, 0.0, 0.0), Vec3(4e5, 4e5, 4e5), Vec3(4e5, 4e5, 1e5), Vec3(4e5, 1e5, 1e5),
                             Vec3(4e5, 4e5 * (1.0 - 1e-15), 0.0), Vec3(4e5, 1e-9, -1e-9), Vec3(-1.0, -1.0, -1e9)})
    expect_decomposes(Q * values.asDiagonal() * Q.transpose(), values.cwiseAbs().maxCoeff());
}

TEST(PrincipalStress, FindsTheAxes) {
  const Mat3 Q = Eigen::AngleAxisd(1.1, Vec3(0.3, -1.0, 0.5).normalized()).toRotationMatrix();
  const PrincipalStress principal = principal_stress(Q * Vec3(-2.0, 7.0, 3.0).asDiagonal() * Q.transpose());
  EXPECT_NEAR(principal.value[0], 7.0, 1e-13);
  EXPECT_NEAR(principal.value[1], 3.0, 1e-13);
  EXPECT_NEAR(principal.value[2], -2.0, 1e-13);
  EXPECT_NEAR(std::abs(principal.axes.col(0).dot(Q.col(1))), 1.0, 1e-14);
  EXPECT_NEAR(std::abs(principal.axes.col(2).dot(Q.col(0))), 1.0, 1e-14);
}

}  // namespace
}  // namespace rhexis::fracture::test
