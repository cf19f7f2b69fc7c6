#include "model/taylor_hood_element.h"

#include <gtest/gtest.h>

#include <cmath>

#include <Eigen/Dense>

#include "material/mooney_rivlin.h"
#include "tests/model/test_bodies.h"

namespace rhexis::model::taylor_hood {
namespace {

double factorial(int n) { return n < 2 ? 1.0 : n * factorial(n - 1); }

/// Mean over the tet of L0^a L1^b L2^c L3^d: 3! a! b! c! d! / (3 + a + b + c + d)!.
double mean_of_monomial(const std::array<int, 4>& powers) {
  double value = 6.0;
  int degree = 3;
  for (const int p : powers) {
    value *= factorial(p);
    degree += p;
  }
  return value / factorial(degree);
}

double rule_mean(const std::array<int, 4>& powers) {
  double sum = 0.0;
  for (const RulePoint& point : kRule) {
    double term = point.weight;
    for (std::size_t i = 0; i < 4; ++i) term *= std::pow(point.L[i], powers[i]);
    sum += term;
  }
  return sum;
}

TEST(TaylorHoodRule, LiesInsideWithPositiveWeights) {
  double sum = 0.0;
  for (const RulePoint& point : kRule) {
    EXPECT_GT(point.weight, 0.0);
    sum += point.weight;
    double total = 0.0;
    for (const double L : point.L) {
      EXPECT_GT(L, 0.0);
      total += L;
    }
    EXPECT_NEAR(total, 1.0, 1e-15);
  }
  EXPECT_NEAR(sum, 1.0, 1e-15);
}

TEST(TaylorHoodRule, IsExactToDegreeFiveAndNoFurther) {
  double worst_of_six = 0.0;
  for (int a = 0; a <= 6; ++a) {
    for (int b = 0; a + b <= 6; ++b) {
      for (int c = 0; a + b + c <= 6; ++c) {
        for (int d = 0; a + b + c + d <= 6; ++d) {
          const double exact = mean_of_monomial({a, b, c, d});
          const double error = std::abs(rule_mean({a, b, c, d}) - exact);
          if (a + b + c + d <= 5) {
            EXPECT_LT(error, 3e-15 * exact) << a << b << c << d;
          } else {
            worst_of_six = std::max(worst_of_six, error / exact);
          }
        }
      }
    }
  }
  EXPECT_GT(worst_of_six, 1e-3);
}

/// A tet, its corners and the positions of its ten nodes.
struct OneTet {
  OneTet() : X(mesh::corners(test::one_tet(), TetId(0))), geometry(geometry_of(X)) {
    for (std::size_t i = 0; i < 4; ++i) nodes.col(static_cast<Eigen::Index>(i)) = X[i];
    for (std::size_t e = 0; e < 6; ++e) {
      nodes.col(static_cast<Eigen::Index>(4 + e)) = 0.5 * (X[static_cast<std::size_t>(mesh::kTetEdges[e][0])] +
                                                           X[static_cast<std::size_t>(mesh::kTetEdges[e][1])]);
    }
  }
  [[nodiscard]] Vec3 at(const std::array<double, 4>& L) const {
    return L[0] * X[0] + L[1] * X[1] + L[2] * X[2] + L[3] * X[3];
  }
  std::array<Vec3, 4> X;
  Geometry geometry;
  NodeColumns nodes;
};

TEST(TaylorHoodShapes, AreOneAtTheirNodeAndZeroAtTheOthers) {
  for (std::size_t node = 0; node < 10; ++node) {
    std::array<double, 4> L{};
    if (node < 4) {
      L[node] = 1.0;
    } else {
      for (const int end : mesh::kTetEdges[node - 4]) L[static_cast<std::size_t>(end)] = 0.5;
    }
    const std::array<double, 10> N = shape_functions(L);
    for (std::size_t a = 0; a < 10; ++a) EXPECT_EQ(N[a], a == node ? 1.0 : 0.0);
  }
}

TEST(TaylorHoodShapes, ReproduceQuadraticsAndTheirGradients) {
  const OneTet tet;
  EXPECT_NEAR(tet.geometry.volume, mesh::signed_volume(test::one_tet(), TetId(0)), 1e-16);
  const Mat3 Q = Mat3::Random();
  const Vec3 q(1.0, -2.0, 0.5);
  const auto field = [&](const Vec3& X) { return X.dot(Q * X) + q.dot(X) + 3.0; };
  for (const RulePoint& point : kRule) {
    const std::array<double, 10> N = shape_functions(point.L);
    const NodeColumns G = shape_gradients(tet.geometry, point.L);
    double value = 0.0;
    double one = 0.0;
    Vec3 gradient = Vec3::Zero();
    for (Eigen::Index a = 0; a < 10; ++a) {
      one += N[static_cast<std::size_t>(a)];
      value += N[static_cast<std::size_t>(a)] * field(tet.nodes.col(a));
      gradient += field(tet.nodes.col(a)) * G.col(a);
    }
    const Vec3 X = tet.at(point.L);
    EXPECT_NEAR(one, 1.0, 1e-15);
    EXPECT_NEAR(value, field(X), 1e-14);
    EXPECT_LT((gradient - ((Q + Q.transpose()) * X + q)).norm(), 1e-13);
    EXPECT_LT(G.rowwise().sum().norm(), 1e-14);
  }
}

TEST(TaylorHoodKinematics, KeepsTheDigitsOfSmallVolumeChanges) {
  const OneTet tet;
  const NodeColumns G = shape_gradients(tet.geometry, kRule[3].L);
  // u = s (X, 2 Y, -3 Z + X): the volume change is (1 + s)(1 + 2 s)(1 - 3 s) - 1 = -7 s^2 - 6 s^3, next to s = 1e-9.
  const double s = 1e-9;
  NodeColumns u;
  for (Eigen::Index a = 0; a < 10; ++a) {
    const Vec3 X = tet.nodes.col(a);
    u.col(a) = s * Vec3(X.x(), 2.0 * X.y(), -3.0 * X.z() + X.x());
  }
  const Kinematics k = kinematics_of(u, G);
  // Rounding of the gradients, 1e-16 s; computed as det F - 1 it would be 1e-16 alone.
  EXPECT_NEAR(k.volume_change, -7.0 * s * s, 1e-14 * s);
  EXPECT_NEAR(k.J, 1.0, 1e-15);
}

TEST(TaylorHoodKinematics, CofactorIsTheGradientOfJ) {
  const OneTet tet;
  test::Noise noise(1);
  NodeColumns u;
  for (Eigen::Index a = 0; a < 10; ++a) u.col(a) = noise.vec3(0.2);
  const Kinematics k = kinematics_of(u, shape_gradients(tet.geometry, kRule[5].L));
  EXPECT_NEAR(k.J, k.F.determinant(), 1e-14);
  EXPECT_LT((k.cof - k.J * k.F.inverse().transpose()).norm(), 1e-13);
}

// Against the chain rule written out over all components, from the law's S and D.
TEST(TaylorHoodModuli, AreTheDerivativeOfTheFirstPiolaKirchhoffStress) {
  const material::MooneyRivlinLaw law{3.0, 2.0};
  const double lambda = 1.7;
  const OneTet tet;
  const NodeColumns G = shape_gradients(tet.geometry, kRule[9].L);
  test::Noise noise(2);
  NodeColumns u;
  for (Eigen::Index a = 0; a < 10; ++a) u.col(a) = noise.vec3(0.1);
  const Kinematics k = kinematics_of(u, G);
  ASSERT_GT(k.J, 0.2);
  const Moduli moduli = moduli_of(law, k, lambda);
  const auto stress = [&](const Mat3& F) -> Mat3 {
    Kinematics at;
    at.F = F;
    at.J = F.determinant();
    return F * law_stress(law, at) + lambda * at.J * F.inverse().transpose();
  };
  double largest = 0.0;
  for (const PaddedBlock& block : moduli) largest = std::max(largest, block.abs().maxCoeff());
  for (int kk = 0; kk < 3; ++kk) {
    for (int L = 0; L < 3; ++L) {
      const auto shifted = [&](double s) {
        Mat3 F = k.F;
        F(kk, L) += s;
        return stress(F);
      };
      const double h = 2e-3;
      const Mat3 slope = (45.0 * (shifted(h) - shifted(-h)) - 9.0 * (shifted(2 * h) - shifted(-2 * h)) +
                          (shifted(3 * h) - shifted(-3 * h))) /
                         (60.0 * h);
      for (int i = 0; i < 3; ++i) {
        for (int J = 0; J < 3; ++J) {
          EXPECT_NEAR(moduli[static_cast<std::size_t>(3 * J + L)][3 * i + kk], slope(i, J), 1e-10 * largest);
        }
      }
    }
  }
}

}  // namespace
}  // namespace rhexis::model::taylor_hood
