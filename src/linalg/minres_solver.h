#pragma once

#include <optional>

#include "linalg/cholesky_factor.h"
#include "linalg/saddle_residual.h"
#include "linalg/saddle_solver.h"
#include "linalg/system_key.h"

namespace rhexis::linalg {

/// A vector of the saddle system.
struct SaddleVector {
  VectorX u;
  VectorX p;
  void set_zero(Eigen::Index nu, Eigen::Index np) {
    u.setZero(nu);
    p.setZero(np);
  }
  [[nodiscard]] double dot(const SaddleVector& other) const { return u.dot(other.u) + p.dot(other.p); }
};

/// Minimum residuals (Paige and Saunders 1975; Elman, Silvester and Wathen, Finite Elements and Fast Iterative Solvers,
/// algorithm 4.1) on the saddle system, which may be indefinite in any way, with the preconditioner diag(A0, S0).
class MinresSolver final : public SaddleSolver {
 public:
  /// `blocks` must outlive the solver; it is factored for the patterns and supports of the first matrix, and anew when
  /// those change.
  explicit MinresSolver(const BlockPreconditioner& blocks) : blocks_(blocks) {}

  LinearReport factor(const SaddleMatrix& K, const FreeDofs& free) override;
  LinearReport solve(const VectorX& bu, const VectorX& bp, double tolerance, VectorX& xu, VectorX& xp) override;
  [[nodiscard]] std::size_t memory_bytes() const override;

 private:
  LinearReport factor_blocks(const SaddleMatrix& K);
  void apply(const SaddleVector& x, SaddleVector& y) const;
  void precondition(const SaddleVector& v, SaddleVector& z);

  const BlockPreconditioner& blocks_;
  const SaddleMatrix* K_ = nullptr;
  SystemKey key_;
  std::optional<CholeskyFactor> a_factor_;
  std::optional<CholeskyFactor> s_factor_;
  SaddleResidual residual_;
  SaddleVector v_, v_before_, v_next_;  ///< Lanczos vectors: K-orthogonalised residuals
  SaddleVector z_, z_next_;             ///< the same, preconditioned
  SaddleVector w_, w_before_, w_next_;  ///< directions of the solution
};

}  // namespace rhexis::linalg
