#pragma once

#include <optional>
#include <vector>

#include "linalg/condensed_preconditioner.h"
#include "linalg/conjugate_gradients.h"
#include "linalg/saddle_residual.h"
#include "linalg/saddle_solver.h"
#include "linalg/system_key.h"

namespace rhexis::linalg {

/// Conjugate gradients on the condensed S = A + B C^-1 B^T: the pressure p = C^-1 (B^T u - bp) is eliminated, and
/// S u = bu + B C^-1 bp. C is factored when it changes (with the topology). The preconditioner is kept from matrix to
/// matrix as long as the iterations it costs stay near those that it cost when it was new: a Newton iteration is then a
/// few solves and no factorisation.
class CondensedCg final : public SaddleSolver {
 public:
  LinearReport factor(const SaddleMatrix& K, const FreeDofs& free) override;
  LinearReport solve(const VectorX& bu, const VectorX& bp, double tolerance, VectorX& xu, VectorX& xp) override;
  [[nodiscard]] std::size_t memory_bytes() const override;

 private:
  CholeskyOutcome take_c(const SaddleMatrix& K);
  LinearReport iterate(const VectorX& bu, const VectorX& bp, double norm, double tolerance, VectorX& xu, VectorX& xp);

  const SaddleMatrix* K_ = nullptr;
  SystemKey key_;
  SaddleResidual residual_;
  std::optional<CholeskyFactor> c_factor_;
  std::vector<double> c_values_;  ///< that were factored
  CondensedPreconditioner preconditioner_;
  bool preconditioner_kept_ = false;  ///< from an earlier matrix
  bool preconditioner_worn_ = true;   ///< the next matrix gets its own
  double new_cost_ = 0.0;             ///< iterations a decade of the residual when it was new
  CgWorkspace work_;
  VectorX r_;
  VectorX p_;
  VectorX q_;
};

}  // namespace rhexis::linalg
