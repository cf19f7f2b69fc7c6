// Closed forms of the incompressible Mooney-Rivlin solid, and the constants of the paper.

#include "material/mooney_rivlin.h"

#include <gtest/gtest.h>

#include <cmath>

#include "material/neo_hookean.h"
#include "material/parameters.h"

namespace rhexis::test {
namespace {

/// sigma_xx - sigma_zz of principal stretches with product 1: free of the pressure.
template <class Law>
double stress_difference(const Law& law, double x, double y, double z) {
  const double F[9] = {x, 0.0, 0.0, 0.0, y, 0.0, 0.0, 0.0, z};
  const material::Sym<double> S = law.stress(material::deformation_of(F, x * y * z));
  return x * x * S.xx - z * z * S.zz;
}

constexpr double kC1 = 2e4, kC2 = 3e4;

TEST(MooneyRivlinLaw, Uniaxial) {
  const material::MooneyRivlinLaw law{kC1, kC2};
  for (const double l : {0.4, 0.8, 1.1, 2.0, 5.0}) {
    const double expected = 2.0 * (l * l - 1.0 / l) * (kC1 + kC2 / l);
    EXPECT_NEAR(stress_difference(law, l, 1.0 / std::sqrt(l), 1.0 / std::sqrt(l)), expected,
                1e-13 * std::abs(expected));
  }
}

TEST(MooneyRivlinLaw, Equibiaxial) {
  const material::MooneyRivlinLaw law{kC1, kC2};
  for (const double l : {0.6, 0.9, 1.2, 2.0, 3.0}) {
    const double expected = 2.0 * (l * l - std::pow(l, -4.0)) * (kC1 + kC2 * l * l);
    EXPECT_NEAR(stress_difference(law, l, l, 1.0 / (l * l)), expected, 1e-13 * std::abs(expected));
  }
}

TEST(MooneyRivlinLaw, EnergyInSimpleShear) {
  // I1bar = I2bar = 3 + g^2 at J = 1.
  for (const double g : {0.1, 1.0, 3.0}) {
    const double F[9] = {1.0, g, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
    EXPECT_NEAR((material::MooneyRivlinLaw{kC1, kC2}.energy(material::deformation_of(F, 1.0))), (kC1 + kC2) * g * g,
                1e-14 * (kC1 + kC2) * (3.0 + g * g));
  }
}

TEST(NeoHookeanLaw, IsMooneyRivlinWithoutItsSecondTerm) {
  const double F[9] = {1.2, 0.3, -0.1, 0.2, 0.9, 0.4, -0.3, 0.1, 1.1};
  const double J = 1.2 * (0.9 * 1.1 - 0.4 * 0.1) - 0.3 * (0.2 * 1.1 + 0.4 * 0.3) - 0.1 * (0.2 * 0.1 + 0.9 * 0.3);
  const auto d = material::deformation_of(F, J);
  const material::NeoHookeanLaw neo{kC1};
  const material::MooneyRivlinLaw full{kC1, 0.0};
  EXPECT_NEAR(neo.energy(d), full.energy(d), 1e-14 * kC1);
  EXPECT_NEAR(neo.stress(d).xy, full.stress(d).xy, 1e-14 * kC1);
  for (int i = 0; i < 21; ++i) EXPECT_NEAR(neo.tangent(d).packed[i], full.tangent(d).packed[i], 1e-13 * kC1) << i;
}

TEST(Parameters, ThePapersConstants) {
  // c1 = c2 = 8.395e4, kappa = 4.167e6 is E = 0.981 MPa, nu = 0.461: not the 1 MPa and 0.49 beside it.
  const material::Elastic elastic = material::to_elastic({8.395e4, 8.395e4, 4.167e6});
  EXPECT_NEAR(elastic.young, 0.981e6, 0.0005e6);
  EXPECT_NEAR(elastic.poisson, 0.461, 0.0005);
  const material::MooneyRivlin back = material::to_mooney_rivlin(elastic);
  EXPECT_NEAR(back.c1, 8.395e4, 1e-9);
  EXPECT_NEAR(back.c2, 8.395e4, 1e-9);
  EXPECT_NEAR(back.kappa, 4.167e6, 1e-6);
  // E = 1 MPa, nu = 0.49 by the formulas of section 6.1: kappa four times what Table 3 lists.
  const material::MooneyRivlin soft = material::to_mooney_rivlin({1e6, 0.49}, true);
  EXPECT_NEAR(soft.c1, 1e6 / (4.0 * 1.49), 1e-6);
  EXPECT_EQ(soft.c2, 0.0);
  EXPECT_NEAR(soft.kappa, 1.6667e7, 1e3);
}

}  // namespace
}  // namespace rhexis::test
