#include <gtest/gtest.h>

#include <set>
#include <utility>

#include "base/parallel.h"
#include "linalg/block_matrix.h"
#include "linalg/saddle_matrix.h"
#include "tests/linalg/random_systems.h"

namespace rhexis::linalg {
namespace {

using test::dense;
using test::MatrixX;

/// Sums of a few dozen terms of order one.
constexpr double kRounding = 1e-13;

TEST(BlockPattern, holds_every_pair_of_an_element_once) {
  std::mt19937 random(1);
  const std::int32_t nodes = 200;  // nodes without an element among them
  const std::vector<std::int32_t> elements = test::random_elements(nodes - 3, 150, random);
  const BlockPattern pattern = make_block_pattern(nodes, elements, 4);

  std::set<std::pair<std::int32_t, std::int32_t>> expected;
  for (std::int32_t node = 0; node < nodes; ++node) expected.emplace(node, node);
  for (std::size_t e = 0; e < elements.size(); e += 4) {
    for (std::size_t a = e; a < e + 4; ++a) {
      for (std::size_t b = e; b < e + 4; ++b) {
        if (elements[a] > elements[b]) expected.emplace(elements[a], elements[b]);
      }
    }
  }
  std::vector<std::pair<std::int32_t, std::int32_t>> found;
  for (std::int32_t row = 0; row < pattern.rows(); ++row) {
    for (std::int32_t k = pattern.row_start[row]; k < pattern.row_start[row + 1]; ++k) {
      found.emplace_back(row, pattern.column[static_cast<std::size_t>(k)]);
      EXPECT_EQ(pattern.find(row, found.back().second), k);
    }
  }
  EXPECT_EQ(pattern.rows(), nodes);
  EXPECT_TRUE(std::equal(found.begin(), found.end(), expected.begin(), expected.end()));  // ascending as a set is
  EXPECT_EQ(pattern.find(nodes - 1, 0), -1);
}

TEST(BlockPattern, lists_the_blocks_below_the_diagonal_by_column) {
  std::mt19937 random(2);
  const BlockPattern pattern = make_block_pattern(60, test::random_elements(60, 40, random), 4);
  std::size_t listed = 0;
  for (std::int32_t col = 0; col < pattern.rows(); ++col) {
    for (std::int32_t k = pattern.below_start[col]; k < pattern.below_start[col + 1]; ++k, ++listed) {
      const std::int32_t row = pattern.below_row[static_cast<std::size_t>(k)];
      EXPECT_GT(row, col);
      EXPECT_EQ(pattern.find(row, col), pattern.below_block[static_cast<std::size_t>(k)]);
    }
  }
  EXPECT_EQ(listed + static_cast<std::size_t>(pattern.rows()), pattern.block_count());
}

TEST(BlockPattern, takes_no_elements_and_elements_of_any_size) {
  const BlockPattern lone = make_block_pattern(3, {}, 4);
  EXPECT_EQ(lone.column, (std::vector<std::int32_t>{0, 1, 2}));
  EXPECT_EQ(make_block_pattern(0, {}, 4).rows(), 0);
  const std::vector<std::int32_t> edge{1, 0};
  EXPECT_EQ(make_block_pattern(2, edge, 2).column, (std::vector<std::int32_t>{0, 0, 1}));
}

TEST(BlockPatternDeathTest, refuses_a_node_out_of_range) {
  const std::vector<std::int32_t> edge{1, 2};
  EXPECT_DEATH(make_block_pattern(2, edge, 2), "node 2 outside");
}

TEST(SymmetricBlockMatrix, multiplies_like_the_dense_matrix) {
  std::mt19937 random(3);
  auto pattern = std::make_shared<BlockPattern>(make_block_pattern(50, test::random_elements(50, 60, random), 4));
  const SymmetricBlockMatrix A = test::random_block_matrix(pattern, 0.0, random);
  const VectorX x = test::random_vector(150, random);
  VectorX y = VectorX::Constant(150, 7.0);
  A.multiply(x, y);
  EXPECT_LT((y - dense(A) * x).lpNorm<Eigen::Infinity>(), kRounding);
}

TEST(SymmetricBlockMatrix, gives_the_same_bits_on_any_number_of_threads) {
  std::mt19937 random(4);
  const std::int32_t nodes = 9000;  // several pieces of rows
  std::vector<std::int32_t> elements;
  for (std::int32_t i = 0; i + 40 < nodes; ++i) elements.insert(elements.end(), {i, i + 1, i + 17, i + 40});
  auto pattern = std::make_shared<BlockPattern>(make_block_pattern(nodes, elements, 4));
  const SymmetricBlockMatrix A = test::random_block_matrix(pattern, 0.0, random);
  const VectorX x = test::random_vector(3 * nodes, random);
  VectorX one(x.size());
  VectorX many(x.size());
  set_thread_count(1);
  A.multiply(x, one);
  for (const int threads : {2, 3, 5}) {
    set_thread_count(threads);
    A.multiply(x, many);
    EXPECT_TRUE(one == many) << threads;
    EXPECT_EQ(make_block_pattern(nodes, elements, 4).column, pattern->column);
  }
  set_thread_count(0);
}

TEST(SaddleMatrix, multiplies_like_the_dense_matrix) {
  std::mt19937 random(5);
  SaddleMatrix K = test::random_saddle(40, 55, 0.0, 1.0, random);
  const VectorX x = test::random_vector(120 + 55, random);
  VectorX yu(120);
  VectorX yp(55);
  const auto difference = [&] {
    K.multiply(x.head(120), x.tail(55), yu, yp);
    VectorX y(175);
    y << yu, yp;
    return (y - dense(K) * x).lpNorm<Eigen::Infinity>();
  };
  EXPECT_LT(difference(), kRounding);
  test::add_random_skew(K, 1.0, random);
  EXPECT_LT(difference(), kRounding);
  const MatrixX A = dense(K).topLeftCorner(120, 120);
  EXPECT_GT((A - A.transpose()).norm(), 1.0);
}

TEST(SaddleMatrix, couples_both_ways) {
  std::mt19937 random(6);
  const SaddleMatrix K = test::random_saddle(30, 20, 0.0, 1.0, random);
  const MatrixX B = dense(K.B, 30);
  const VectorX u = test::random_vector(90, random);
  const VectorX p = test::random_vector(20, random);
  VectorX Btu(20);
  K.B.multiply(u, Btu);
  EXPECT_LT((Btu - B.transpose() * u).lpNorm<Eigen::Infinity>(), kRounding);
  VectorX sum = u;
  K.B.add_transposed(p, -2.5, sum);
  EXPECT_LT((sum - (u - 2.5 * (B * p))).lpNorm<Eigen::Infinity>(), kRounding);
  VectorX Cp(20);
  K.C.multiply(p, Cp);
  EXPECT_LT((Cp - dense(K.C) * p).lpNorm<Eigen::Infinity>(), kRounding);
}

TEST(FreeDofs, count_what_is_not_held) {
  const FreeDofs free = make_free_dofs({true, false, false, true, false});
  EXPECT_EQ(free.index, (std::vector<std::int32_t>{-1, 0, 1, -1, 2}));
  EXPECT_EQ(free.dof, (std::vector<std::int32_t>{1, 2, 4}));
  EXPECT_EQ(make_free_dofs({}).count(), 0);
}

}  // namespace
}  // namespace rhexis::linalg
