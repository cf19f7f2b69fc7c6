#pragma once

/// A fixed linear map that stands in for the inverse of a diagonally dominant matrix C whose slow part is smooth, as
/// the jump matrix of pressures is. Pressures constant on patches (the columns of W, m x k) are solved for exactly, the
/// rest by steps of Chebyshev's semi-iteration from zero on D^-1 C (Saad, Iterative Methods, alg. 12.1):
///
///     Q = W (W^T C W)^-1 W^T,  P = I - C Q,      x = Q b + P^T p(P C) P b.
///
/// Symmetric and positive definite like the inverse, without a factorisation and without memory that changes: two
/// threads may apply one at once. Without the patches it would take as many steps as C is ill-conditioned on constants:
/// seventy where ten do.

#include <cstdint>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/SparseCore>

#include "base/vec.h"
#include "linalg/saddle_matrix.h"

namespace rhexis::linalg {

class ChebyshevInverse {
 public:
  ChebyshevInverse() = default;
  /// C strictly diagonally dominant with a positive diagonal (RHEXIS_CHECK). `reduction`: of the error, about.
  ChebyshevInverse(const SymmetricCsr& C, double reduction);

  [[nodiscard]] int steps() const { return steps_; }
  struct Work {
    VectorX residual, step, product, coarse, exact;
  };
  /// x ~ C^-1 b; x is not b.
  void apply(const VectorX& b, VectorX& x, Work& work) const;
  [[nodiscard]] std::size_t memory_bytes() const;

 private:
  /// y = M x, M = D^-1/2 C D^-1/2.
  void multiply(const VectorX& x, VectorX& y) const;
  /// v -= M Q v, or v -= Q M v.
  void project(VectorX& v, VectorX& coarse) const;
  void project_transposed(VectorX& v, VectorX& coarse) const;
  [[nodiscard]] double smallest_eigenvalue() const;
  void iterate(VectorX& x, Work& work) const;

  Eigen::Index rows_ = 0;
  VectorX root_;                           ///< D^-1/2
  std::vector<std::int32_t> start_, col_;  ///< both triangles without the diagonal, which is 1
  std::vector<double> value_;
  std::vector<std::int32_t> patch_;  ///< per row
  VectorX weight_;                   ///< of each row in its column of W, in the scaled unknowns: D^1/2
  Eigen::SparseMatrix<double, Eigen::RowMajor> product_;  ///< M W, rows x k
  Eigen::LLT<Eigen::MatrixXd> coarse_;                    ///< W^T M W
  double centre_ = 1.0, half_width_ = 0.0;                ///< of the interval that holds the eigenvalues
  int steps_ = 1;
};

}  // namespace rhexis::linalg
