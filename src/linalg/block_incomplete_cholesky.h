#pragma once

/// Incomplete Cholesky A ~ L L^T without fill, by 3 x 3 blocks of the nodes, on the pattern of A. Where a diagonal
/// block stops being positive definite the diagonal of A is raised (Manteuffel's shift) and the factorisation starts
/// over.

#include <cstddef>
#include <memory>
#include <vector>

#include "linalg/saddle_matrix.h"

namespace rhexis::linalg {

class BlockIncompleteCholesky {
 public:
  /// False when no shift helped: A is far from positive definite. Held dofs are replaced by the identity.
  bool factor(const SymmetricBlockMatrix& A, const FreeDofs& free);
  /// z = (L L^T)^-1 r; both of length 3 * rows, zero on held dofs. No allocation.
  void solve(const VectorX& r, VectorX& z) const;
  /// By which the diagonal was multiplied beyond one; 0 where the matrix itself could be factored.
  [[nodiscard]] double shift() const { return shift_; }
  [[nodiscard]] std::size_t memory_bytes() const;

 private:
  bool try_factor(const SymmetricBlockMatrix& A, const FreeDofs& free);

  std::shared_ptr<const BlockPattern> pattern_;
  std::vector<double> values_;  ///< L by blocks, row-major; diagonal blocks hold the inverse of L_ii (lower triangular)
  std::vector<std::int32_t> at_;  ///< work: place of each column in the current row, -1
  double shift_ = 0.0;
};

}  // namespace rhexis::linalg
