// What every law has to keep. A further law is one more line in `Laws`.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include <Eigen/Dense>

#include "material/mooney_rivlin.h"
#include "material/neo_hookean.h"
#include "material/st_venant_kirchhoff.h"
#include "tests/material/dual.h"

namespace rhexis::test {
namespace {

using material::Deformation;
using material::Sym;
using material::Sym66;
using Mat3 = Eigen::Matrix3d;
using Mat6 = Eigen::Matrix<double, 6, 6>;
using Vec6 = Eigen::Matrix<double, 6, 1>;

template <auto kLaw>
struct Of {
  static constexpr auto law = kLaw;
};

using Laws = testing::Types<Of<material::MooneyRivlinLaw{2e4, 3e4}>,      //
                            Of<material::MooneyRivlinLaw{8.395e4, 0.0}>,  //
                            Of<material::NeoHookeanLaw{5e4}>,             //
                            Of<material::StVenantKirchhoffLaw{1.4e5, 3.6e4}>>;

/// Moduli above are near this: errors are measured against it.
constexpr double kModulus = 1e5;

Vec6 to_vector(const Sym<double>& s) { return Vec6(s.xx, s.yy, s.zz, s.xy, s.yz, s.xz); }

template <class T>
Deformation<T> from_C(const Sym<T>& C) {
  const Sym<T> adjugate = material::adjugate(C);
  const T det = C.xx * adjugate.xx + C.xy * adjugate.xy + C.xz * adjugate.xz;
  using std::sqrt;
  return {C, material::scaled(adjugate, T(1.0) / det), sqrt(det)};
}

Deformation<double> from_F(const Mat3& F) {
  double f[9];
  for (int i = 0; i < 9; ++i) f[i] = F(i / 3, i % 3);
  return material::deformation_of(f, F.determinant());
}

/// Stretches between about 0.5 and 2, any rotation, J > 0.
std::vector<Mat3> deformations() {
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  std::vector<Mat3> out;
  while (out.size() < 40) {
    Mat3 F = Mat3::Identity();
    for (double& value : F.reshaped()) value += 0.3 * normal(random);
    if (F.determinant() < 0.2) continue;
    out.push_back(Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random))
                      .normalized()
                      .toRotationMatrix() *
                  F);
  }
  return out;
}

/// C with a unit derivative along one tensor component (both of a shear).
Sym<Dual> along(const Sym<double>& C, int component) {
  Sym<Dual> out{C.xx, C.yy, C.zz, C.xy, C.yz, C.xz};
  const std::array<Dual*, 6> entries{&out.xx, &out.yy, &out.zz, &out.xy, &out.yz, &out.xz};
  entries[static_cast<std::size_t>(component)]->d = 1.0;
  return out;
}

template <class Law>
class LawContract : public testing::Test {};
TYPED_TEST_SUITE(LawContract, Laws);

TYPED_TEST(LawContract, NothingAtRest) {
  const Deformation<double> rest = from_F(Mat3::Identity());
  EXPECT_EQ(TypeParam::law.energy(rest), 0.0);
  EXPECT_LT(to_vector(TypeParam::law.stress(rest)).norm(), 1e-15 * kModulus);
}

TYPED_TEST(LawContract, RotationIsRest) {
  const Mat3 Q = Eigen::AngleAxisd(2.5, Eigen::Vector3d(1.0, 2.0, -1.0).normalized()).toRotationMatrix();
  EXPECT_LT(std::abs(TypeParam::law.energy(from_F(Q))), 1e-14 * kModulus);
  EXPECT_LT(to_vector(TypeParam::law.stress(from_F(Q))).norm(), 1e-14 * kModulus);
}

TYPED_TEST(LawContract, StressIsTheDerivativeOfTheEnergy) {
  for (const Mat3& F : deformations()) {
    const Deformation<double> d = from_F(F);
    const Vec6 S = to_vector(TypeParam::law.stress(d));
    ASSERT_GT(S.norm(), 1e-3 * kModulus);
    for (int c = 0; c < 6; ++c) {
      const double slope = TypeParam::law.energy(from_C(along(d.C, c))).d;
      // S = 2 dW/dC; a shear component stands twice in C. Derivatives are exact: rounding alone, grown by |C^-1|.
      EXPECT_NEAR((c < 3 ? 2.0 : 1.0) * slope, S[c], 1e-12 * S.norm()) << c;
    }
  }
}

TYPED_TEST(LawContract, TangentIsTheDerivativeOfTheStressAndSymmetric) {
  for (const Mat3& F : deformations()) {
    const Deformation<double> d = from_F(F);
    const Sym66<double> packed = TypeParam::law.tangent(d);
    Mat6 D, measured;
    for (int c = 0; c < 6; ++c) {
      const Sym<Dual> S = TypeParam::law.stress(from_C(along(d.C, c)));
      // dC = 2 dE: a normal component of 1 is a strain of 1/2, a shear component of 1 an engineering strain of 1.
      measured.col(c) = (c < 3 ? 2.0 : 1.0) * Vec6(S.xx.d, S.yy.d, S.zz.d, S.xy.d, S.yz.d, S.xz.d);
      for (int r = 0; r < 6; ++r) D(r, c) = packed(r, c);
    }
    ASSERT_GT(D.norm(), 0.1 * kModulus);
    EXPECT_LT((D - measured).norm(), 1e-12 * D.norm());
    EXPECT_LT((measured - measured.transpose()).norm(), 1e-12 * D.norm());
  }
}

TYPED_TEST(LawContract, DoesNotSeeRotation) {
  const Mat3 Q = Eigen::AngleAxisd(-1.1, Eigen::Vector3d(0.3, 2.0, 1.0).normalized()).toRotationMatrix();
  for (const Mat3& F : deformations()) {
    const Deformation<double> d = from_F(F), turned = from_F(Q * F);
    EXPECT_NEAR(TypeParam::law.energy(d), TypeParam::law.energy(turned), 1e-12 * kModulus);
    const Vec6 S = to_vector(TypeParam::law.stress(d));
    EXPECT_LT((S - to_vector(TypeParam::law.stress(turned))).norm(), 1e-12 * (S.norm() + kModulus));
  }
}

TYPED_TEST(LawContract, IsochoricLawsAndNoOthersIgnoreVolume) {
  double energy_change = 0.0, mean_stress = 0.0;
  for (const Mat3& F : deformations()) {
    const Deformation<double> d = from_F(F);
    energy_change += std::abs(TypeParam::law.energy(from_F(1.3 * F)) - TypeParam::law.energy(d));
    mean_stress += std::abs(material::contract(TypeParam::law.stress(d), d.C)) / d.J;  // tr(sigma)
  }
  if (TypeParam::law.kIsochoric) {
    EXPECT_LT(energy_change, 1e-12 * kModulus);
    EXPECT_LT(mean_stress, 1e-12 * kModulus);
  } else {
    EXPECT_GT(energy_change, kModulus);
    EXPECT_GT(mean_stress, kModulus);
  }
}

TYPED_TEST(LawContract, IsotropicAndStableAtRest) {
  const Sym66<double> packed = TypeParam::law.tangent(from_F(Mat3::Identity()));
  Mat6 D;
  for (int r = 0; r < 6; ++r) {
    for (int c = 0; c < 6; ++c) D(r, c) = packed(r, c);
  }
  const double mu = D(3, 3);
  EXPECT_GT(mu, 0.0);
  EXPECT_NEAR(D(0, 0) - D(0, 1), 2.0 * mu, 1e-14 * kModulus);
  EXPECT_NEAR(D(4, 4), mu, 1e-14 * kModulus);
  // Volume: an isochoric law has no resistance, another one some.
  const double bulk = D.topLeftCorner<3, 3>().sum() / 9.0;
  EXPECT_EQ(TypeParam::law.kIsochoric, std::abs(bulk) < 1e-10 * kModulus);
}

}  // namespace
}  // namespace rhexis::test
