#pragma once

/// What a preconditioner of S = A + B C^-1 B^T needs to know of C (condensed_preconditioner.h): D = diag(C) / w, which
/// stands in for it element by element, and the Nystroem correction for E = C^-1 - D^-1 on pressures that are constant
/// on patches, the columns of W (m x k):
///
///     E ~ (E W) (W^T E W)^-1 (E W)^T,       P~ = P + V G^-1 V^T,   V = B E W,  G = W^T E W,
///     P~^-1 = P^-1 - P^-1 V (G + V^T P^-1 V)^-1 V^T P^-1.
///
/// E W and G depend on C alone and stay while C does; P^-1 V costs k solves per factorisation of P.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

#include <Eigen/Cholesky>

#include "base/vec.h"
#include "linalg/saddle_matrix.h"

namespace rhexis::linalg {

class PressurePatches {
 public:
  /// x = M^-1 b by columns; x has the size of b.
  using Solve = std::function<void(const Eigen::MatrixXd& b, Eigen::MatrixXd& x)>;

  /// Takes C: D, patches, E W, G. A and B of K set the weight alone.
  void set(const SaddleMatrix& K, const Solve& c_inverse);
  /// Takes B and the inverse of P, over the free dofs.
  void correct(const SaddleMatrix& K, const FreeDofs& free, const Solve& p_inverse);
  /// The body has taken copies of some of its nodes and P has followed; `copied`: the node that each appended one is a
  /// copy of. Copies that move as one are what P was, so that P~ stays definite: no softer anywhere than P has become.
  void follow(std::span<const std::int32_t> copied, const FreeDofs& free);
  /// From z = P^-1 r to z = P~^-1 r.
  void apply(const VectorX& r, VectorX& z) const { apply_lanes<1>(r, z); }
  void apply(const TwoLanes& r, TwoLanes& z) const { apply_lanes<2>(r, z); }
  void apply(const FourLanes& r, FourLanes& z) const { apply_lanes<4>(r, z); }

  [[nodiscard]] Eigen::Index count() const { return smooth_.cols(); }
  /// Of D, m^3/Pa; empty without pressures.
  [[nodiscard]] const VectorX& diagonal() const { return d_; }
  [[nodiscard]] std::size_t memory_bytes() const;

 private:
  template <int k>
  void apply_lanes(const Lanes<k>& r, Lanes<k>& z) const;

  VectorX d_;
  Eigen::MatrixXd smooth_;              ///< E W, m x k
  Eigen::MatrixXd G_;                   ///< W^T E W, k x k
  Eigen::MatrixXf V_;                   ///< P^-1 V, 3n x k: as exact as a solve with P is
  Eigen::LLT<Eigen::MatrixXd> coarse_;  ///< of G + V^T P^-1 V
};

}  // namespace rhexis::linalg
