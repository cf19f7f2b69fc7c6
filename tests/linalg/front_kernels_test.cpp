#include "linalg/front_kernels.h"

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include <limits>
#include <random>
#include <vector>

namespace rhexis::linalg {
namespace {

using Eigen::MatrixXd;
using Eigen::MatrixXf;
using Eigen::VectorXd;
using Eigen::VectorXf;

class FrontKernelsOf : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    kernels = find_front_kernels(GetParam());
    if (kernels == nullptr) GTEST_SKIP() << "not on this processor";
  }
  const FrontKernels* kernels = nullptr;
};

MatrixXd random_matrix(Eigen::Index rows, Eigen::Index columns, std::mt19937_64& random) {
  return MatrixXd::NullaryExpr(rows, columns, [&] { return static_cast<double>(random() % 2001) / 1000.0 - 1.0; });
}

// Diagonal entries of the size of the matrix: condition numbers below ten, so that errors are those of the sums.
constexpr double kSame = 1e-14;
constexpr double kSameSingle = 1e-6;

TEST_P(FrontKernelsOf, factor_like_the_dense_factor) {
  std::mt19937_64 random(1);
  for (const int columns : {1, 2, 31, 32, 33, 70, 200}) {
    for (const int below : {0, 1, 5, 90}) {
      const int rows = columns + below;
      const int ld = rows + 3;
      MatrixXd whole = random_matrix(rows, rows, random);
      whole = (whole * whole.transpose() / rows + 2.0 * MatrixXd::Identity(rows, rows)).eval();
      MatrixXd panel = MatrixXd::Constant(ld, columns, std::numeric_limits<double>::quiet_NaN());
      for (int j = 0; j < columns; ++j) panel.col(j).segment(j, rows - j) = whole.col(j).tail(rows - j);
      std::vector<double> work(static_cast<std::size_t>(rows) * kFactorWidth);
      std::vector<double> inverse(static_cast<std::size_t>(columns + kFactorWidth) * kFactorWidth);
      ASSERT_TRUE(kernels->factor(panel.data(), columns, ld, inverse.data(), work.data()));
      kernels->solve_rows(panel.data() + columns, below, panel.data(), inverse.data(), columns, ld, work.data());
      const MatrixXd expected = whole.llt().matrixL();
      for (int j = 0; j < columns; ++j) {
        EXPECT_LT((panel.col(j).segment(j, rows - j) - expected.col(j).tail(rows - j)).norm(), kSame * rows)
            << rows << " x " << columns << ", column " << j;
      }
      // With the factor: both substitutions.
      MatrixXd lower = MatrixXd::Zero(rows, columns);
      for (int j = 0; j < columns; ++j) lower.col(j).tail(rows - j) = expected.col(j).tail(rows - j);
      const auto top = lower.topRows(columns).triangularView<Eigen::Lower>();
      MatrixXd r = random_matrix(rows, 4, random);
      const MatrixXd y = top.solve(r.topRows(columns));
      const MatrixXd rest = r.bottomRows(below) - lower.bottomRows(below) * y;
      kernels->forward(panel.data(), ld, columns, below, r.data(), rows, 4);
      EXPECT_LT((r.topRows(columns) - y).norm(), kSame * rows);
      EXPECT_LT((r.bottomRows(below) - rest).norm(), kSame * rows);
      VectorXd x = random_matrix(rows, 1, random);
      const VectorXd solved =
          top.transpose().solve(x.head(columns) - lower.bottomRows(below).transpose() * x.tail(below));
      kernels->backward(panel.data(), ld, columns, below, x.data());
      EXPECT_LT((x.head(columns) - solved).norm(), kSame * rows);
      // And with its inverted blocks in single precision.
      const int ldw = (rows + kSinglePacket - 1) / kSinglePacket * kSinglePacket;
      MatrixXf W = MatrixXf::Zero(ldw, columns);
      kernels->invert_panel(panel.data(), ld, columns, below, W.data(), ldw);
      const MatrixXd inverse_of_top = top.solve(MatrixXd::Identity(columns, columns));
      MatrixXd wanted(rows, columns);
      wanted << inverse_of_top, lower.bottomRows(below) * inverse_of_top;
      EXPECT_LT((W.topRows(rows).cast<double>() - wanted).norm(), kSameSingle * wanted.norm());
      for (const int lanes : {1, 2, 4}) {
        const MatrixXf p = random_matrix(columns, lanes, random).cast<float>();
        MatrixXf product(ldw, lanes);
        kernels->multiply_single(W.data(), ldw, ldw, columns, lanes, p.data(), columns, product.data(), ldw);
        const MatrixXd expected_product = wanted * p.cast<double>();
        EXPECT_LT((product.topRows(rows).cast<double>() - expected_product).norm(), kSameSingle * lanes * rows);
        EXPECT_TRUE((product.bottomRows(ldw - rows).array() == 0.0F).all());
        MatrixXf back(columns, lanes);
        kernels->multiply_transposed_single(W.data(), ldw, ldw, columns, lanes, product.data(), ldw, back.data(),
                                            columns);
        const MatrixXd expected_back = wanted.transpose() * product.topRows(rows).cast<double>();
        EXPECT_LT((back.cast<double>() - expected_back).norm(), kSameSingle * lanes * rows);
      }
    }
  }
}

TEST_P(FrontKernelsOf, refuse_what_is_not_positive_definite_or_not_a_number) {
  for (const double bad : {-1.0, 0.0, std::numeric_limits<double>::quiet_NaN()}) {
    for (const int place : {0, 20, 40, 99}) {
      MatrixXd A = 2.0 * MatrixXd::Identity(100, 100);
      A(place, place) = bad;
      std::vector<double> work(100 * kFactorWidth);
      std::vector<double> inverse(128 * kFactorWidth);
      EXPECT_FALSE(kernels->factor(A.data(), 100, 100, inverse.data(), work.data())) << bad << " at " << place;
    }
  }
}

TEST_P(FrontKernelsOf, subtract_products_and_add) {
  std::mt19937_64 random(2);
  for (const int depth : {1, 40, 300}) {
    for (const int columns : {1, 64, 100}) {
      const MatrixXd A = random_matrix(150, depth, random);
      MatrixXd C = random_matrix(130, columns, random);
      const MatrixXd expected = C.topRows(120) - A.bottomRows(120) * A.middleRows(30, columns).transpose();
      kernels->subtract_lower(C.data(), 130, A.data() + 30, 150, 120, columns, depth);
      for (int j = 0; j < columns; ++j) {
        EXPECT_LT((C.col(j).segment(j, 120 - j) - expected.col(j).tail(120 - j)).norm(), 8.0 * kSame * depth);
      }
    }
  }
  VectorXd a = random_matrix(37, 1, random);
  const VectorXd b = random_matrix(37, 1, random);
  const VectorXd sum = a + b;
  kernels->add(a.data(), b.data(), 37);
  EXPECT_TRUE(a == sum);
}

INSTANTIATE_TEST_SUITE_P(All, FrontKernelsOf, testing::Values("portable", "avx2", "avx512"));

TEST(FrontKernels, are_found_by_name_alone) {
  EXPECT_EQ(find_front_kernels("mmx"), nullptr);
  EXPECT_NE(front_kernels().factor, nullptr);
}

}  // namespace
}  // namespace rhexis::linalg
