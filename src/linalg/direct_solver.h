#pragma once

#include <optional>
#include <vector>

#include "linalg/cholesky_factor.h"
#include "linalg/mumps_factor.h"
#include "linalg/saddle_residual.h"
#include "linalg/saddle_solver.h"
#include "linalg/saddle_triplets.h"
#include "linalg/system_key.h"

namespace rhexis::linalg {

/// Cholesky where the matrix allows it, else L D L^T with inertia, else (skew part) L U; each analysed when it is first
/// needed and kept while pattern and supports stay. Solutions are refined on the matrix itself.
class DirectSolver final : public SaddleSolver {
 public:
  LinearReport factor(const SaddleMatrix& K, const FreeDofs& free) override;
  LinearReport solve(const VectorX& bu, const VectorX& bp, double tolerance, VectorX& xu, VectorX& xp) override;
  [[nodiscard]] std::size_t memory_bytes() const override;

 private:
  enum class Method { none, cholesky, mumps };
  /// MUMPS with the entries and the order that it reads.
  struct Assembled {
    SaddleTriplets triplets;
    std::vector<std::int32_t> place;
    MumpsFactor factor;
    std::vector<double> values;
    VectorX right;
    Assembled(const SaddleMatrix& K, const FreeDofs& free, bool general);
  };

  CholeskyOutcome try_cholesky();
  LinearReport factor_assembled(bool was_indefinite);
  /// x += K^-1 residual.
  void add_correction(VectorX& xu, VectorX& xp);

  const SaddleMatrix* K_ = nullptr;
  SystemKey key_;
  SaddleResidual residual_;
  Method method_ = Method::none;
  std::optional<CholeskyFactor> cholesky_;
  std::optional<Assembled> assembled_;
  std::optional<int> negative_pivots_;
  VectorX correction_;
};

}  // namespace rhexis::linalg
