#pragma once

/// Multifrontal L D L^T with its inertia, and L U, of a sparse matrix given by triplets (MUMPS, the sequential build).
///
/// empty -> analysed -> factored -> solved any number of times -> factored again

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "base/vec.h"

namespace rhexis::linalg {

enum class MumpsOutcome { ok, singular, out_of_memory };

class MumpsFactor {
 public:
  enum class Kind { symmetric, general };
  explicit MumpsFactor(Kind kind);
  ~MumpsFactor();
  MumpsFactor(MumpsFactor&&) noexcept;
  MumpsFactor& operator=(MumpsFactor&&) noexcept;

  /// Rows and columns of the entries, counted from 1, and the order of elimination (1-based place of every unknown).
  /// Symmetric: one triangle. The spans are read by later factorisations: keep them.
  MumpsOutcome analyse(std::int32_t size, std::span<const std::int32_t> rows, std::span<const std::int32_t> columns,
                       std::span<const std::int32_t> place);
  /// Values of those entries, in that order.
  MumpsOutcome factor(std::span<const double> values);
  /// x <- A^-1 x.
  void solve(VectorX& x);

  /// Negative eigenvalues of the matrix; symmetric alone.
  [[nodiscard]] int negative_pivots() const;
  /// Pivots that were nothing but rounding; the matrix is singular when there are any.
  [[nodiscard]] int null_pivots() const;
  [[nodiscard]] std::size_t memory_bytes() const;

 private:
  struct Instance;
  std::unique_ptr<Instance> instance_;
};

}  // namespace rhexis::linalg
