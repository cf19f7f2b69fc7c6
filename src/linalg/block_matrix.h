#pragma once

/// Symmetric matrices of 3 x 3 blocks on a fixed pattern: the displacement block A of every tangent. One block row per
/// node of the displacement space. Stored is the lower triangle by block rows, so that assembly writes each pair of
/// nodes once; the pattern is shared, since it changes only with the topology.

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "linalg/lanes.h"

namespace rhexis::linalg {

/// Lower triangle with the diagonal: columns of a row ascend and end with the row itself. Made by make_block_pattern
/// alone, which keeps the two halves in step.
struct BlockPattern {
  std::vector<std::int32_t> row_start;  ///< rows + 1 offsets into `column`
  std::vector<std::int32_t> column;     ///< block column of each stored block, <= its row

  /// The same blocks seen from their columns, without the diagonal: what lets a product gather instead of scatter, so
  /// that every row is summed by one thread in one order.
  std::vector<std::int32_t> below_start;  ///< rows + 1 offsets into the next two
  std::vector<std::int32_t> below_row;    ///< rows below the diagonal in this column, ascending
  std::vector<std::int32_t> below_block;  ///< index of that block

  [[nodiscard]] std::int32_t rows() const {
    return row_start.empty() ? 0 : static_cast<std::int32_t>(row_start.size()) - 1;
  }
  [[nodiscard]] std::size_t block_count() const { return column.size(); }
  /// Index of the block (row, col), row >= col; -1 when the pattern has none.
  [[nodiscard]] std::int32_t find(std::int32_t row, std::int32_t col) const;
};

/// Every pair of nodes of an element, and every diagonal. `connectivity` lists the nodes element by element,
/// `nodes_per_element` each, all in [0, rows).
[[nodiscard]] BlockPattern make_block_pattern(std::int32_t rows, std::span<const std::int32_t> connectivity,
                                              std::int32_t nodes_per_element);

struct SymmetricBlockMatrix {
  std::shared_ptr<const BlockPattern> pattern;
  std::vector<double> values;  ///< 9 per block, row-major; diagonal blocks are stored whole and are symmetric

  SymmetricBlockMatrix() = default;
  /// All zero.
  explicit SymmetricBlockMatrix(std::shared_ptr<const BlockPattern> of);
  [[nodiscard]] std::int32_t rows() const { return pattern ? pattern->rows() : 0; }
  void set_zero();
  /// y = A x; both of 3 * rows() rows. No allocation; the same bits whatever the number of threads.
  void multiply(const VectorX& x, VectorX& y) const;
  template <int k>
  void multiply(const Lanes<k>& x, Lanes<k>& y) const;
};

}  // namespace rhexis::linalg
