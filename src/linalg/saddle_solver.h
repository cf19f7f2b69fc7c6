#pragma once

/// One interface for the linear systems of a Newton step, chosen by name:
///
///   direct   m = 0: sparse Cholesky (CHOLMOD); when A is not positive definite, and for m > 0: LDL^T (MUMPS) with its
///            inertia; with a skew part: LU (MUMPS)
///   cg       m = 0: conjugate gradients on A, preconditioned by an incomplete Cholesky factor; m > 0: on the condensed
///            A + B C^-1 B^T, C factored once per topology, preconditioned by one Cholesky of A + B D^-1 B^T, D =
///            diag(C) weighted, and a coarse correction on patch-wise constant pressures, which is kept from matrix to
///            matrix while it pays (condensed_preconditioner.h, docs/solvers.md)
///   minres   MINRES on the saddle system with the block preconditioner diag(A0, S0): A0 an SPD stand-in for A, S0 for
///            the Schur complement, factored once per topology; the iteration count stays flat under refinement
///
/// States: empty -> factored -> solved any number of times -> factored again (same pattern: the analysis is kept).

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "linalg/saddle_matrix.h"

namespace rhexis::linalg {

enum class LinearOutcome { ok, singular, indefinite, not_converged, not_supported, not_finite };

struct LinearReport {
  LinearOutcome outcome = LinearOutcome::ok;
  int iterations = 0;                  ///< 0 for direct
  double relative_residual = 0.0;      ///< |K x - b| / |b|, measured, not estimated
  std::optional<int> negative_pivots;  ///< beyond the m of a stable saddle point; empty where it cannot be known
  std::string message;                 ///< one line: what happened and what would help; empty when nothing did
  [[nodiscard]] bool ok() const { return outcome == LinearOutcome::ok; }
};

/// SPD stand-ins for MINRES, from the model in its reference state.
struct BlockPreconditioner {
  SymmetricBlockMatrix A0;
  SymmetricCsr S0;
};

class SaddleSolver {
 public:
  virtual ~SaddleSolver() = default;
  /// Takes the matrix over the free dofs. K must outlive the solves. A changed pattern or changed supports are noticed
  /// and analysed anew.
  virtual LinearReport factor(const SaddleMatrix& K, const FreeDofs& free) = 0;
  /// K (xu, xp) = (bu, bp) over the free dofs; held dofs of xu come out zero, of bu are not read. `tolerance`
  /// bounds |K x - b| / |b| for the iterative ones; direct refines towards it.
  virtual LinearReport solve(const VectorX& bu, const VectorX& bp, double tolerance, VectorX& xu, VectorX& xp) = 0;
  /// Bytes held by factors and work space.
  [[nodiscard]] virtual std::size_t memory_bytes() const = 0;
};

/// `name` one of direct, cg, minres (checked by the scene). The preconditioner blocks are read by minres alone.
[[nodiscard]] std::unique_ptr<SaddleSolver> make_saddle_solver(std::string_view name,
                                                               const BlockPreconditioner* blocks);

}  // namespace rhexis::linalg
