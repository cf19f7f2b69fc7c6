#pragma once

/// The saddle system over its free dofs as one scalar matrix in triplets: unknowns are the free dofs, then the
/// pressures. The places are found once per pattern; every later matrix is copied through them.

#include <cstdint>
#include <vector>

#include "linalg/saddle_matrix.h"

namespace rhexis::linalg {

class SaddleTriplets {
 public:
  /// `general` lists both triangles, with the skew part; otherwise one triangle is listed and K has no skew part.
  SaddleTriplets(const SaddleMatrix& K, const FreeDofs& free, bool general);

  [[nodiscard]] std::int32_t size() const { return size_; }
  /// Counted from 1.
  [[nodiscard]] const std::vector<std::int32_t>& rows() const { return rows_; }
  [[nodiscard]] const std::vector<std::int32_t>& columns() const { return columns_; }
  /// Fills `values` in the order of rows() and columns().
  void gather(const SaddleMatrix& K, std::vector<double>& values) const;
  [[nodiscard]] std::size_t memory_bytes() const;

 private:
  void add_a(const BlockPattern& pattern, const FreeDofs& free);
  void add_b(const CsrPattern& pattern, const FreeDofs& free);
  void add_c(const CsrPattern& pattern);
  void add(std::int32_t row, std::int32_t column, std::size_t source);

  bool general_ = false;
  std::int32_t size_ = 0;
  std::int32_t free_count_ = 0;
  std::vector<std::int32_t> rows_;
  std::vector<std::int32_t> columns_;
  std::vector<std::uint32_t> source_;  ///< place of each value in A, B or C
  /// Ends of the four stretches: the lower triangle of A, its transpose (general alone), B and its transpose, C.
  std::size_t lower_end_ = 0;
  std::size_t upper_end_ = 0;
  std::size_t coupling_end_ = 0;
};

}  // namespace rhexis::linalg
