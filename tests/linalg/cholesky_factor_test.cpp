#include "linalg/cholesky_factor.h"

#include <gtest/gtest.h>

#include "tests/linalg/random_systems.h"
#include "tests/support/box_problem.h"

namespace rhexis::linalg {
namespace {

using test::MatrixX;

std::shared_ptr<const BlockPattern> random_pattern(std::int32_t nodes, std::mt19937& random) {
  return std::make_shared<BlockPattern>(make_block_pattern(nodes, test::random_elements(nodes, nodes, random), 4));
}

/// b over the free dofs, x over all.
VectorX dense_solution(const SymmetricBlockMatrix& A, const FreeDofs& free, const VectorX& b) {
  const VectorX x = test::restrict(test::dense(A), free).llt().solve(b(free.dof));
  VectorX out = VectorX::Zero(b.size());
  out(free.dof) = x;
  return out;
}

class CholeskyFactorOrders : public testing::TestWithParam<Ordering> {};

TEST_P(CholeskyFactorOrders, solves_like_the_dense_factor) {
  std::mt19937 random(11);
  for (const std::int32_t nodes : {1, 5, 40, 120}) {
    const SymmetricBlockMatrix A = test::random_block_matrix(random_pattern(std::max(nodes, 4), random), 40.0, random);
    const FreeDofs free = test::random_supports(3 * A.rows(), random);
    CholeskyFactor factor(GetParam());
    ASSERT_EQ(factor.analyse(*A.pattern, free), CholeskyOutcome::ok);
    ASSERT_EQ(factor.factor(A.values), CholeskyOutcome::ok);
    const VectorX b = test::random_vector(3 * A.rows(), random);
    VectorX x(b.size());
    factor.solve(b, x);
    const VectorX expected = dense_solution(A, free, b);
    EXPECT_LT((x - expected).norm(), 1e-13 * expected.norm()) << nodes;  // condition below ten
    EXPECT_EQ(factor.size(), free.count());
    EXPECT_GT(factor.memory_bytes(), sizeof(double) * static_cast<std::size_t>(free.count()));
  }
}

INSTANTIATE_TEST_SUITE_P(All, CholeskyFactorOrders, testing::Values(Ordering::metis, Ordering::amd, Ordering::best));

TEST(CholeskyFactor, refactors_with_other_values_and_survives_an_indefinite_matrix) {
  std::mt19937 random(12);
  const auto pattern = random_pattern(60, random);
  const FreeDofs free = test::random_supports(180, random);
  CholeskyFactor factor;
  ASSERT_EQ(factor.analyse(*pattern, free), CholeskyOutcome::ok);
  const VectorX b = test::random_vector(180, random);
  VectorX x(180);
  for (int round = 0; round < 3; ++round) {
    const SymmetricBlockMatrix bad = test::random_block_matrix(pattern, 0.0, random);
    EXPECT_EQ(factor.factor(bad.values), CholeskyOutcome::not_positive_definite);
    const SymmetricBlockMatrix A = test::random_block_matrix(pattern, 30.0 + round, random);
    ASSERT_EQ(factor.factor(A.values), CholeskyOutcome::ok);
    factor.solve(b, x);
    const VectorX expected = dense_solution(A, free, b);
    EXPECT_LT((x - expected).norm(), 1e-13 * expected.norm());
  }
}

TEST(CholeskyFactor, takes_many_right_hand_sides_and_works_in_place) {
  std::mt19937 random(13);
  const SymmetricBlockMatrix A = test::random_block_matrix(random_pattern(30, random), 40.0, random);
  const FreeDofs free = test::random_supports(90, random);
  CholeskyFactor factor;
  ASSERT_EQ(factor.analyse(*A.pattern, free), CholeskyOutcome::ok);
  ASSERT_EQ(factor.factor(A.values), CholeskyOutcome::ok);
  MatrixX b = MatrixX::NullaryExpr(90, 7, [&] { return test::uniform(random); });
  MatrixX x(90, 7);
  factor.solve(b, x);
  for (int col = 0; col < 7; ++col) {
    const VectorX expected = dense_solution(A, free, b.col(col));
    EXPECT_LT((x.col(col) - expected).norm(), 1e-13 * expected.norm());
  }
  factor.solve(b, b);
  EXPECT_TRUE(b == x);
}

TEST(CholeskyFactor, factors_scalar_matrices) {
  std::mt19937 random(14);
  const SymmetricCsr C = test::random_saddle(20, 70, 0.0, 1.0, random).C;
  CholeskyFactor factor;
  ASSERT_EQ(factor.analyse(*C.pattern), CholeskyOutcome::ok);
  ASSERT_EQ(factor.factor(C.values), CholeskyOutcome::ok);
  const VectorX b = test::random_vector(70, random);
  VectorX x(70);
  factor.solve(b, x);
  EXPECT_LT((test::dense(C) * x - b).norm(), 1e-14 * b.norm());  // diagonally dominant
}

TEST(CholeskyFactor, knows_what_cancellation_left_of_a_pivot) {
  const test::BoxProblem problem = test::make_box_problem(test::make_box({3, 3, 3}, 1.0), {});
  const SymmetricBlockMatrix& A = problem.displacement_only;
  CholeskyFactor factor;
  ASSERT_EQ(factor.analyse(*A.pattern, problem.free), CholeskyOutcome::ok);
  ASSERT_EQ(factor.factor(A.values), CholeskyOutcome::ok);
  // The smallest pivot lies between the smallest eigenvalue of the scaled matrix and one.
  MatrixX scaled = test::restrict(test::dense(A), problem.free);
  const VectorX d = scaled.diagonal().cwiseSqrt().cwiseInverse();
  scaled = d.asDiagonal() * scaled * d.asDiagonal();
  const double least = scaled.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff();
  EXPECT_GT(factor.smallest_pivot(), least);
  EXPECT_LT(factor.smallest_pivot(), 1.0);
  SymmetricBlockMatrix shrunk = A;  // other units, same answer
  for (double& value : shrunk.values) value *= 1e-9;
  const double before = factor.smallest_pivot();
  ASSERT_EQ(factor.factor(shrunk.values), CholeskyOutcome::ok);
  EXPECT_NEAR(factor.smallest_pivot(), before, 1e-10 * before);
}

TEST(CholeskyFactor, holds_nothing_when_nothing_is_free) {
  const BlockPattern pattern = make_block_pattern(2, {}, 4);
  CholeskyFactor factor;
  ASSERT_EQ(factor.analyse(pattern, make_free_dofs(std::vector<bool>(6, true))), CholeskyOutcome::ok);
  ASSERT_EQ(factor.factor(std::vector<double>(18)), CholeskyOutcome::ok);
  VectorX x = VectorX::Ones(6);
  factor.solve(x, x);
  EXPECT_TRUE(x.isZero(0.0));
  EXPECT_EQ(factor.smallest_pivot(), 1.0);
}

}  // namespace
}  // namespace rhexis::linalg
