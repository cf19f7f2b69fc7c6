#pragma once

/// A SymmetricBlockMatrix unfolded for being multiplied with often: both triangles, row after row in memory, in single
/// precision. A product reads as many bytes as with the lower triangle in double, but one after the other, where half
/// of that triangle's blocks are found by column and wait for the cache: three times as fast where the matrix lies in
/// no cache of the core's own.

#include <cstdint>
#include <memory>
#include <vector>

#include "linalg/block_matrix.h"

namespace rhexis::linalg {

class WholeRows {
 public:
  /// Takes the values, and the pattern if it is another one.
  void take(const SymmetricBlockMatrix& A);
  /// y = A x but for the rounding of A to single precision, for 1, 2 or 4 lanes; both of 3 rows per block row.
  template <int k>
  void multiply(const Lanes<k>& x, Lanes<k>& y) const;
  [[nodiscard]] std::size_t memory_bytes() const;

 private:
  void take_pattern(std::shared_ptr<const BlockPattern> pattern);

  std::shared_ptr<const BlockPattern> pattern_;
  std::vector<std::int32_t> start_, column_;
  std::vector<std::int32_t> source_;  ///< block of A; the complement of one that is transposed
  std::vector<float> values_;         ///< 9 per block, row-major
};

}  // namespace rhexis::linalg
