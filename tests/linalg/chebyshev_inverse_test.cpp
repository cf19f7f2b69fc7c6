#include "linalg/chebyshev_inverse.h"

#include <gtest/gtest.h>

#include <cmath>

#include "linalg/cholesky_factor.h"
#include "tests/support/box_problem.h"

namespace rhexis::linalg {
namespace {

/// The bound of the smallest eigenvalue is an estimate: the error may be this many times what was asked for.
constexpr double kSlack = 2.0;
/// Single precision, a few sums.
constexpr double kRounding = 1e-6;

SymmetricCsr pressure_matrix(double beta) {
  const mesh::TetMesh mesh = test::make_box({6, 5, 8}, 0.1);
  return test::make_box_problem(mesh, {.mu = 1.0, .kappa = 25.0, .beta = beta}).K.C;
}

VectorX wave(Eigen::Index rows, double frequency) {
  VectorX out(rows);
  for (Eigen::Index i = 0; i < rows; ++i) out[i] = 1.0 + std::sin(frequency * static_cast<double>(i));
  return out;
}

TEST(ChebyshevInverse, IsWithinTheReductionThatWasAskedFor) {
  for (const double beta : {1.0, 9.0, 100.0}) {
    const SymmetricCsr C = pressure_matrix(beta);
    CholeskyFactor exact;
    ASSERT_EQ(exact.analyse(*C.pattern), CholeskyOutcome::ok);
    ASSERT_EQ(exact.factor(C.values), CholeskyOutcome::ok);
    for (const double reduction : {1e-1, 1e-2, 1e-4}) {
      const ChebyshevInverse inverse(C, reduction);
      ChebyshevInverse::Work work;
      for (const double frequency : {0.0, 0.01, 0.7, 2.9}) {
        const VectorX b = wave(C.rows(), frequency);
        VectorX x;
        inverse.apply(b, x, work);
        VectorX expected(b.size());
        exact.solve(b, expected);
        const VectorX off = x - expected;
        VectorX c_off(b.size());
        VectorX c_expected(b.size());
        C.multiply(off, c_off);
        C.multiply(expected, c_expected);
        EXPECT_LE(std::sqrt(off.dot(c_off) / expected.dot(c_expected)), kSlack * reduction)
            << "beta " << beta << ", " << inverse.steps() << " steps";
      }
    }
  }
}

/// What the patches are for: the steps do not grow as C's condition number, 1 + 60 beta or so.
TEST(ChebyshevInverse, TakesFewStepsHoweverLargeTheJumpsCount) {
  EXPECT_EQ(ChebyshevInverse(pressure_matrix(0.0), 1e-2).steps(), 1);
  const int few = ChebyshevInverse(pressure_matrix(9.0), 1e-2).steps();
  EXPECT_LE(few, 40);
  EXPECT_LE(ChebyshevInverse(pressure_matrix(1000.0), 1e-2).steps(), few + 10);
}

TEST(ChebyshevInverse, IsSymmetricAndPositive) {
  const SymmetricCsr C = pressure_matrix(9.0);
  const ChebyshevInverse inverse(C, 1e-1);
  ChebyshevInverse::Work work;
  const VectorX a = wave(C.rows(), 0.3);
  const VectorX b = wave(C.rows(), 1.7);
  VectorX Ma;
  VectorX Mb;
  inverse.apply(a, Ma, work);
  inverse.apply(b, Mb, work);
  EXPECT_NEAR(a.dot(Mb), b.dot(Ma), kRounding * std::abs(a.dot(Mb)));
  EXPECT_GT(a.dot(Ma), 0.0);
}

TEST(ChebyshevInverse, OfADiagonalIsItsInverse) {
  const SymmetricCsr C = pressure_matrix(0.0);
  const ChebyshevInverse inverse(C, 0.5);
  ChebyshevInverse::Work work;
  const VectorX b = wave(C.rows(), 0.3);
  VectorX x;
  inverse.apply(b, x, work);
  VectorX back(b.size());
  C.multiply(x, back);
  EXPECT_LE((back - b).norm(), kRounding * b.norm());
}

}  // namespace
}  // namespace rhexis::linalg
