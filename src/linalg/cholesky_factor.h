#pragma once

/// Sparse Cholesky P A P^T = L L^T (CHOLMOD) for one pattern and many values: the analysis (fill-reducing order,
/// elimination tree, supernodes) is made once, every later factorisation copies values through a precomputed map and
/// computes.
///
/// empty -> analysed -> factored -> solved any number of times -> factored again

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

#include "linalg/saddle_matrix.h"

namespace rhexis::linalg {

enum class CholeskyOutcome { ok, not_positive_definite, out_of_memory };

/// How the order of elimination is found; `best` tries both and keeps the one with fewer operations.
enum class Ordering { metis, amd, best };

class CholeskyFactor {
 public:
  explicit CholeskyFactor(Ordering ordering = Ordering::best);
  ~CholeskyFactor();
  CholeskyFactor(CholeskyFactor&&) noexcept;
  CholeskyFactor& operator=(CholeskyFactor&&) noexcept;

  /// For matrices of 3 x 3 blocks, over their free dofs.
  CholeskyOutcome analyse(const BlockPattern& pattern, const FreeDofs& free);
  /// For scalar matrices, over all unknowns.
  CholeskyOutcome analyse(const CsrPattern& pattern);

  /// `values` of the SymmetricBlockMatrix or SymmetricCsr whose pattern was analysed; held rows and columns are not
  /// read.
  CholeskyOutcome factor(std::span<const double> values);

  /// x = A^-1 b by columns, one or many; rows as in the pattern (3 per node, or 1), held rows of b are not read and
  /// those of x come out zero. Does not allocate when the number of columns is that of the last call. x may be b.
  void solve(const Eigen::Ref<const Eigen::MatrixXd>& b, Eigen::Ref<Eigen::MatrixXd> x);

  /// Smallest L_ii^2 / A_ii: what cancellation has left of a diagonal entry. 1 for a diagonal matrix, of the order of
  /// rounding when the matrix is singular. Independent of the units of the unknowns.
  [[nodiscard]] double smallest_pivot() const;
  /// Unknowns of the factor, entries of L, and operations of one factorisation.
  [[nodiscard]] std::int32_t size() const;
  [[nodiscard]] double entries() const;
  [[nodiscard]] double flops() const;
  /// Held by the factor, the map and the work space.
  [[nodiscard]] std::size_t memory_bytes() const;

 private:
  struct Core;
  std::unique_ptr<Core> core_;
};

}  // namespace rhexis::linalg
