#pragma once

/// Small random systems on irregular patterns, and their dense twins: the oracles of this room.

#include <Eigen/Dense>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <random>
#include <vector>

#include "linalg/saddle_matrix.h"

namespace rhexis::linalg::test {

using MatrixX = Eigen::MatrixXd;

/// Elements of four different nodes each, drawn at random.
inline std::vector<std::int32_t> random_elements(std::int32_t nodes, int elements, std::mt19937& random) {
  std::vector<std::int32_t> all(static_cast<std::size_t>(nodes));
  for (std::int32_t i = 0; i < nodes; ++i) all[static_cast<std::size_t>(i)] = i;
  std::vector<std::int32_t> connectivity;
  for (int e = 0; e < elements; ++e) {
    std::shuffle(all.begin(), all.end(), random);
    connectivity.insert(connectivity.end(), all.begin(), all.begin() + 4);
  }
  return connectivity;
}

inline double uniform(std::mt19937& random) { return std::uniform_real_distribution<double>(-1.0, 1.0)(random); }

/// Random values with `shift` on the diagonal: large makes it positive definite, zero indefinite.
inline SymmetricBlockMatrix random_block_matrix(std::shared_ptr<const BlockPattern> pattern, double shift,
                                                std::mt19937& random) {
  SymmetricBlockMatrix A(std::move(pattern));
  for (double& value : A.values) value = uniform(random);
  for (std::int32_t row = 0; row < A.rows(); ++row) {
    Eigen::Map<Mat3> block(A.values.data() + 9 * std::ptrdiff_t{A.pattern->find(row, row)});
    block = (0.5 * (block + block.transpose())).eval() + shift * Mat3::Identity();
  }
  return A;
}

/// Random matrix of `m` pressures, each coupled to the nodes of one element and (through C) to a few others.
inline SaddleMatrix random_saddle(std::int32_t nodes, std::int32_t m, double shift, double c_scale,
                                  std::mt19937& random) {
  const std::vector<std::int32_t> connectivity = random_elements(nodes, std::max<int>(nodes, m), random);
  SaddleMatrix K;
  K.A = random_block_matrix(std::make_shared<BlockPattern>(make_block_pattern(nodes, connectivity, 4)), shift, random);
  auto coupling = std::make_shared<CsrPattern>();
  auto jumps = std::make_shared<CsrPattern>();
  coupling->row_start.push_back(0);
  jumps->row_start.push_back(0);
  for (std::int32_t row = 0; row < m; ++row) {
    std::vector<std::int32_t> columns(connectivity.begin() + 4 * row, connectivity.begin() + 4 * row + 4);
    std::sort(columns.begin(), columns.end());
    coupling->column.insert(coupling->column.end(), columns.begin(), columns.end());
    coupling->row_start.push_back(static_cast<std::int32_t>(coupling->column.size()));
    for (const std::int32_t back : {5, 2, 1, 0}) {
      if (row >= back) jumps->column.push_back(row - back);
    }
    jumps->row_start.push_back(static_cast<std::int32_t>(jumps->column.size()));
  }
  K.B = CouplingMatrix(coupling);
  for (double& value : K.B.values) value = uniform(random);
  K.C = SymmetricCsr(jumps);
  for (std::int32_t row = 0; row < m; ++row) {
    for (std::int32_t k = jumps->row_start[row]; k < jumps->row_start[row + 1]; ++k) {
      K.C.values[static_cast<std::size_t>(k)] =
          c_scale * (jumps->column[static_cast<std::size_t>(k)] == row ? 4.0 : 0.6 * uniform(random));
    }
  }
  return K;
}

inline void add_random_skew(SaddleMatrix& K, double scale, std::mt19937& random) {
  K.skew.emplace();
  K.skew->values.resize(K.A.values.size());
  for (double& value : K.skew->values) value = scale * uniform(random);
  for (std::int32_t row = 0; row < K.A.rows(); ++row) {
    Eigen::Map<Mat3> block(K.skew->values.data() + 9 * std::ptrdiff_t{K.A.pattern->find(row, row)});
    block = (0.5 * (block - block.transpose())).eval();
  }
}

inline MatrixX dense(const SymmetricBlockMatrix& A, const SkewBlocks* skew = nullptr) {
  MatrixX out = MatrixX::Zero(3 * A.rows(), 3 * A.rows());
  using Block = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>;
  for (std::int32_t row = 0; row < A.rows(); ++row) {
    for (std::int32_t k = A.pattern->row_start[row]; k < A.pattern->row_start[row + 1]; ++k) {
      const std::int32_t col = A.pattern->column[static_cast<std::size_t>(k)];
      Mat3 lower = Block(A.values.data() + 9 * std::ptrdiff_t{k});
      Mat3 upper = lower.transpose();
      if (skew != nullptr) {
        const Mat3 s = Block(skew->values.data() + 9 * std::ptrdiff_t{k});
        lower += s;
        upper -= s.transpose();
      }
      out.block<3, 3>(3 * row, 3 * col) = lower;
      if (col != row) out.block<3, 3>(3 * col, 3 * row) = upper;
    }
  }
  return out;
}

inline MatrixX dense(const CouplingMatrix& B, std::int32_t nodes) {  // 3n x m
  MatrixX out = MatrixX::Zero(3 * nodes, B.rows());
  for (std::int32_t row = 0; row < B.rows(); ++row) {
    for (std::int32_t k = B.pattern->row_start[row]; k < B.pattern->row_start[row + 1]; ++k) {
      const std::int32_t node = B.pattern->column[static_cast<std::size_t>(k)];
      for (int c = 0; c < 3; ++c) out(3 * node + c, row) = B.values[3 * static_cast<std::size_t>(k) + c];
    }
  }
  return out;
}

inline MatrixX dense(const SymmetricCsr& C) {
  MatrixX out = MatrixX::Zero(C.rows(), C.rows());
  for (std::int32_t row = 0; row < C.rows(); ++row) {
    for (std::int32_t k = C.pattern->row_start[row]; k < C.pattern->row_start[row + 1]; ++k) {
      const std::int32_t col = C.pattern->column[static_cast<std::size_t>(k)];
      out(row, col) = out(col, row) = C.values[static_cast<std::size_t>(k)];
    }
  }
  return out;
}

/// [[A, B], [B^T, -C]], skew part included.
inline MatrixX dense(const SaddleMatrix& K) {
  const int n = K.displacement_unknowns();
  const int m = K.pressure_unknowns();
  MatrixX out = MatrixX::Zero(n + m, n + m);
  out.topLeftCorner(n, n) = dense(K.A, K.skew ? &*K.skew : nullptr);
  if (m > 0) {
    out.topRightCorner(n, m) = dense(K.B, K.A.rows());
    out.bottomLeftCorner(m, n) = out.topRightCorner(n, m).transpose();
    out.bottomRightCorner(m, m) = -dense(K.C);
  }
  return out;
}

/// Rows and columns of the free dofs and of all pressures.
inline MatrixX restrict(const MatrixX& K, const FreeDofs& free) {
  std::vector<Eigen::Index> keep(free.dof.begin(), free.dof.end());
  for (auto i = static_cast<Eigen::Index>(free.index.size()); i < K.rows(); ++i) keep.push_back(i);
  return K(keep, keep);
}

inline VectorX random_vector(Eigen::Index size, std::mt19937& random) {
  VectorX out(size);
  for (double& value : out) value = uniform(random);
  return out;
}

/// About a fifth of the dofs held.
inline FreeDofs random_supports(std::int32_t dofs, std::mt19937& random) {
  std::vector<bool> held(static_cast<std::size_t>(dofs));
  for (std::size_t i = 0; i < held.size(); ++i) held[i] = uniform(random) > 0.6;
  return make_free_dofs(held);
}

}  // namespace rhexis::linalg::test
