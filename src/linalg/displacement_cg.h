#pragma once

#include "linalg/block_incomplete_cholesky.h"
#include "linalg/conjugate_gradients.h"
#include "linalg/saddle_residual.h"
#include "linalg/saddle_solver.h"

namespace rhexis::linalg {

/// Conjugate gradients on A, without pressures; preconditioned by an incomplete Cholesky factor.
class DisplacementCg final : public SaddleSolver {
 public:
  LinearReport factor(const SaddleMatrix& K, const FreeDofs& free) override;
  LinearReport solve(const VectorX& bu, const VectorX& bp, double tolerance, VectorX& xu, VectorX& xp) override;
  [[nodiscard]] std::size_t memory_bytes() const override { return preconditioner_.memory_bytes(); }

 private:
  const SaddleMatrix* K_ = nullptr;
  FreeDofs free_;
  SaddleResidual residual_;
  BlockIncompleteCholesky preconditioner_;
  CgWorkspace work_;
  VectorX r_;
};

}  // namespace rhexis::linalg
