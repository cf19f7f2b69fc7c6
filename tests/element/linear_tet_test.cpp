#include "element/linear_tet.h"

#include <gtest/gtest.h>

#include <Eigen/Core>

namespace rhexis::element {
namespace {

const std::array<Vec3, 4> kCorners{Vec3(0.1, 0.0, 0.2), Vec3(1.3, 0.1, 0.0), Vec3(0.2, 0.9, 0.1), Vec3(0.3, 0.2, 1.1)};
const material::Elastic kElastic{2.0e3, 0.3};
// Products of a dozen numbers of order one times the modulus.
constexpr double kRounding = 1e-12;

TEST(LinearTet, GradientOfAnAffineFieldIsItsMatrix) {
  Mat3 A;
  A << 0.3, -0.2, 0.1, 0.5, 0.7, -0.4, 0.2, 0.6, -0.9;
  std::array<Vec3, 4> u;
  for (std::size_t a = 0; a < 4; ++a) u[a] = A * kCorners[a] + Vec3(1.0, 2.0, 3.0);
  const LinearTet tet = make_linear_tet(kCorners);
  EXPECT_LT((displacement_gradient(tet, u) - A).norm(), kRounding);
}

TEST(LinearTet, StiffnessIsTheWorkOfStressOnStrain) {
  // v^T K u = V sigma(u) : grad v for any u and v: the definition, without the products that K is coded by.
  const LinearTet tet = make_linear_tet(kCorners);
  ASSERT_GT(tet.volume, 0.0);
  Eigen::Matrix<double, 12, 12> K;
  small_strain_stiffness(kElastic, tet, K);
  for (int i = 0; i < 12; ++i) {
    std::array<Vec3, 4> u{Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
    u[static_cast<std::size_t>(i / 3)][i % 3] = 1.0;
    const Mat3 sigma = small_strain_stress(kElastic, displacement_gradient(tet, u));
    for (int j = 0; j < 12; ++j) {
      std::array<Vec3, 4> v{Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
      v[static_cast<std::size_t>(j / 3)][j % 3] = 1.0;
      const double work = tet.volume * sigma.cwiseProduct(displacement_gradient(tet, v)).sum();
      EXPECT_NEAR(K(j, i), work, kRounding * kElastic.young) << i << ' ' << j;
    }
  }
}

TEST(LinearTet, RotationsLeaveNoStress) {
  Mat3 spin;
  spin << 0.0, -0.3, 0.2, 0.3, 0.0, -0.1, -0.2, 0.1, 0.0;
  EXPECT_LT(small_strain_stress(kElastic, spin).norm(), kRounding * kElastic.young);
}

}  // namespace
}  // namespace rhexis::element
