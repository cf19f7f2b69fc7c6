#pragma once

/// Factors of the stiffness of one topology after another, all in the pattern of the intact body. A factor begins with
/// that of the topology before: only the columns that what has changed reaches in the elimination tree are computed
/// again, and each is the same sum in the same order as from nothing, so that the bits do not tell which way was taken.

#include <cstdint>
#include <span>
#include <vector>

#include "linalg/block_matrix.h"
#include "linalg/saddle_matrix.h"
#include "record/store/operator.h"

namespace rhexis::record::build {

/// The pattern, and what finds its way about in it.
class OperatorLayout {
 public:
  /// In the order of METIS or of AMD, whichever leaves fewer entries. `pattern`: of the intact stiffness.
  OperatorLayout(const linalg::BlockPattern& pattern, const linalg::FreeDofs& free);

  [[nodiscard]] const store::OperatorPattern& pattern() const { return pattern_; }
  /// Per dof: its row, -1 when held.
  [[nodiscard]] const std::vector<std::int32_t>& row_of() const { return row_of_; }
  /// Number of the entry (row, column), row >= column; -1 when the pattern has none.
  [[nodiscard]] std::int64_t entry(std::int32_t row, std::int32_t column) const;
  /// Entries of a row left of its diagonal, by columns.
  struct RowEntry {
    std::int32_t column;
    std::int64_t entry;
  };
  [[nodiscard]] std::span<const RowEntry> row_entries(std::int32_t row) const;

 private:
  store::OperatorPattern pattern_;
  std::vector<std::int32_t> row_of_;
  std::vector<std::int64_t> row_start_;
  std::vector<RowEntry> row_entries_;
};

class OperatorFactor {
 public:
  /// Nothing is factored yet. The layout outlives this.
  explicit OperatorFactor(const OperatorLayout& layout);

  /// `stiffness`: one value per entry of the pattern. False: not positive definite, and this is of no more use.
  [[nodiscard]] bool update(const std::vector<double>& stiffness);
  [[nodiscard]] const std::vector<double>& values() const { return values_; }
  /// By the last update, of rows() columns.
  [[nodiscard]] std::int32_t columns_made() const { return columns_made_; }
  /// The entries of K^-1 at the pattern (Takahashi, Fagan, Chin 1973): those of all pairs of dofs of one element are
  /// among them.
  [[nodiscard]] std::vector<double> selected_inverse() const;

 private:
  const OperatorLayout* layout_;
  std::vector<double> stiffness_;
  std::vector<double> values_;
  std::int32_t columns_made_ = 0;
};

}  // namespace rhexis::record::build
