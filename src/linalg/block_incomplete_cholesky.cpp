#include "linalg/block_incomplete_cholesky.h"

#include <Eigen/Cholesky>

#include <algorithm>

namespace rhexis::linalg {
namespace {

using Block = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
using BlockMap = Eigen::Map<Block>;
using ConstBlockMap = Eigen::Map<const Block>;

/// Held rows and columns replaced by those of the identity.
void mask(const FreeDofs& free, std::int32_t row, std::int32_t col, BlockMap block) {
  for (std::int32_t a = 0; a < 3; ++a) {
    for (std::int32_t b = 0; b < 3; ++b) {
      const bool held = free.index[static_cast<std::size_t>(3 * row + a)] < 0 ||
                        free.index[static_cast<std::size_t>(3 * col + b)] < 0;
      if (held) block(a, b) = row == col && a == b ? 1.0 : 0.0;
    }
  }
}

}  // namespace

bool BlockIncompleteCholesky::factor(const SymmetricBlockMatrix& A, const FreeDofs& free) {
  pattern_ = A.pattern;
  at_.assign(static_cast<std::size_t>(A.rows()), -1);
  constexpr double kFirstShift = 1e-2;
  constexpr double kLargestShift = 2.0;  // diagonally dominant by then, were A positive definite
  shift_ = 0.0;
  while (!try_factor(A, free)) {
    std::fill(at_.begin(), at_.end(), -1);
    shift_ = shift_ == 0.0 ? kFirstShift : 3.0 * shift_;
    if (shift_ > kLargestShift) return false;
  }
  return true;
}

bool BlockIncompleteCholesky::try_factor(const SymmetricBlockMatrix& A, const FreeDofs& free) {
  values_ = A.values;
  const BlockPattern& p = *pattern_;
  const auto block = [&](std::int32_t k) { return BlockMap(values_.data() + 9 * std::ptrdiff_t{k}); };
  for (std::int32_t row = 0; row < p.rows(); ++row) {
    const std::int32_t first = p.row_start[static_cast<std::size_t>(row)];
    const std::int32_t diagonal = p.row_start[static_cast<std::size_t>(row) + 1] - 1;
    for (std::int32_t k = first; k <= diagonal; ++k) {
      const std::int32_t col = p.column[static_cast<std::size_t>(k)];
      at_[static_cast<std::size_t>(col)] = k;
      mask(free, row, col, block(k));
    }
    BlockMap pivot = block(diagonal);
    for (int c = 0; c < 3; ++c) pivot(c, c) *= 1.0 + shift_;
    // L_rc = (A_rc - sum_j L_rj L_cj^T) L_cc^-T over the columns j that both rows have
    for (std::int32_t k = first; k < diagonal; ++k) {
      const auto col = static_cast<std::size_t>(p.column[static_cast<std::size_t>(k)]);
      const std::int32_t col_diagonal = p.row_start[col + 1] - 1;
      Block sum = block(k);
      for (std::int32_t j = p.row_start[col]; j < col_diagonal; ++j) {
        const std::int32_t shared = at_[static_cast<std::size_t>(p.column[static_cast<std::size_t>(j)])];
        if (shared >= 0) sum.noalias() -= block(shared) * block(j).transpose();
      }
      block(k).noalias() = sum * block(col_diagonal).transpose();
      pivot.noalias() -= block(k) * block(k).transpose();
    }
    const Eigen::LLT<Block> llt(pivot);
    if (llt.info() != Eigen::Success) return false;
    pivot = llt.matrixL().solve(Block::Identity());
    for (std::int32_t k = first; k <= diagonal; ++k) {
      at_[static_cast<std::size_t>(p.column[static_cast<std::size_t>(k)])] = -1;
    }
  }
  return true;
}

void BlockIncompleteCholesky::solve(const VectorX& r, VectorX& z) const {
  const BlockPattern& p = *pattern_;
  const auto block = [&](std::int32_t k) { return ConstBlockMap(values_.data() + 9 * std::ptrdiff_t{k}); };
  for (std::int32_t row = 0; row < p.rows(); ++row) {
    const std::int32_t diagonal = p.row_start[static_cast<std::size_t>(row) + 1] - 1;
    Vec3 sum = r.segment<3>(3 * row);
    for (std::int32_t k = p.row_start[static_cast<std::size_t>(row)]; k < diagonal; ++k) {
      sum.noalias() -= block(k) * z.segment<3>(3 * p.column[static_cast<std::size_t>(k)]);
    }
    z.segment<3>(3 * row).noalias() = block(diagonal) * sum;
  }
  for (std::int32_t row = p.rows() - 1; row >= 0; --row) {
    const std::int32_t diagonal = p.row_start[static_cast<std::size_t>(row) + 1] - 1;
    const Vec3 solved = block(diagonal).transpose() * z.segment<3>(3 * row);
    z.segment<3>(3 * row) = solved;
    for (std::int32_t k = p.row_start[static_cast<std::size_t>(row)]; k < diagonal; ++k) {
      z.segment<3>(3 * p.column[static_cast<std::size_t>(k)]).noalias() -= block(k).transpose() * solved;
    }
  }
}

std::size_t BlockIncompleteCholesky::memory_bytes() const {
  return sizeof(double) * values_.capacity() + sizeof(std::int32_t) * at_.capacity();
}

}  // namespace rhexis::linalg
