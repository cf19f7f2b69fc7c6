#pragma once

/// The preconditioner of the condensed operator S = A + B C^-1 B^T.
///
/// First part: one Cholesky factor of P = A + B D^-1 B^T, D = diag(C) / w; its pattern is that of A when a pressure
/// couples the nodes of one element. C = M / kappa + jumps is diag(C) up to a factor of two on pressures that oscillate
/// from tet to tet, and far below it on smooth ones, so P lacks E = C^-1 - D^-1, which is large on smooth pressures.
/// The weight w >= 1 makes up for part of that where it costs nothing: oscillating pressures hardly matter beside A as
/// long as B D^-1 B^T is small against A, so w raises its trace to a fixed share of that of A. On a vessel of 16,000
/// tets with kappa / mu = 50 and beta = 9 it halves the iterations.
///
/// Second part: those few are put back. W are the indicators of patches of pressures (m x k), and
///
///     E ~ (E W) (W^T E W)^-1 (E W)^T,       P~ = P + V G^-1 V^T,   V = B E W,  G = W^T E W,
///     P~^-1 = P^-1 - P^-1 V (G + V^T P^-1 V)^-1 V^T P^-1,
///
/// Nystroem's approximation, exact on W (pressure_patches.h).

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "linalg/cholesky_factor.h"
#include "linalg/pressure_patches.h"
#include "linalg/saddle_matrix.h"

namespace rhexis::linalg {

class CondensedPreconditioner {
 public:
  /// For the patterns of K, over the free dofs.
  CholeskyOutcome analyse(const SaddleMatrix& K, const FreeDofs& free);
  /// Takes C and its factor: D and the patches. Again whenever C changes. A and B of K set the weight alone.
  void set_c(const SaddleMatrix& K, CholeskyFactor& c_factor);
  /// Takes A and B. Raises the diagonal when P is not positive definite, which A may cause while S is sound.
  CholeskyOutcome factor(const SaddleMatrix& K, const FreeDofs& free);
  /// z = P~^-1 r; zero on held dofs.
  void solve(const VectorX& r, VectorX& z);

  [[nodiscard]] Eigen::Index patches() const { return patches_.count(); }
  [[nodiscard]] double shift() const { return shift_; }
  [[nodiscard]] std::size_t memory_bytes() const;

 private:
  void assemble(const SaddleMatrix& K);

  SymmetricBlockMatrix P_;
  std::vector<std::int32_t> a_block_;     ///< per block of A, its block in P; empty: the patterns are one
  std::vector<std::int32_t> pair_block_;  ///< per pair of nodes of a pressure, row by row, its block in P
  CholeskyFactor factor_;
  PressurePatches patches_;
  double shift_ = 0.0;
};

}  // namespace rhexis::linalg
