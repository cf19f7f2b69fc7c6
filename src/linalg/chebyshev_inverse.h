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
///
/// In single precision within: what is asked for is a part of the inverse, and what it costs is reading C once a step.

#include <cstdint>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "base/vec.h"
#include "linalg/saddle_matrix.h"

namespace rhexis::linalg {

class ChebyshevInverse {
 public:
  ChebyshevInverse() = default;
  /// C strictly diagonally dominant with a positive diagonal (RHEXIS_CHECK). `reduction`: of the error, about; 1e-5 and
  /// less is lost in rounding.
  ChebyshevInverse(const SymmetricCsr& C, double reduction);

  [[nodiscard]] int steps() const { return steps_; }
  struct Work {
    Eigen::VectorXf residual, step, x, without_smooth, coarse, solved, first;
  };
  /// x ~ C^-1 b; x may be b.
  void apply(const VectorX& b, VectorX& x, Work& work) const;
  [[nodiscard]] std::size_t memory_bytes() const;

 private:
  /// A part of M W that is not in the patch of its row.
  struct Far {
    std::int32_t row, patch;
    float value;
  };
  /// In double, while it is taken.
  struct Scaled {
    VectorX root;                                          ///< D^-1/2
    std::vector<double> value;                             ///< of M
    Eigen::SparseMatrix<double, Eigen::RowMajor> product;  ///< M W
    Eigen::LLT<Eigen::MatrixXd> coarse;                    ///< of W^T M W
  };
  Scaled take_matrix(const SymmetricCsr& C);
  void take_patches(Scaled& exact);
  [[nodiscard]] double smallest_eigenvalue(const Scaled& exact) const;
  [[nodiscard]] std::size_t patches() const { return patch_start_.size() - 1; }

  /// Row i of M x, M = D^-1/2 C D^-1/2.
  [[nodiscard]] float row_of_product(std::size_t i, const Eigen::VectorXf& x) const {
    float sum = x[static_cast<Eigen::Index>(i)];
    for (std::int32_t p = start_[i]; p < start_[i + 1]; ++p)
      sum += value_[static_cast<std::size_t>(p)] * x[col_[static_cast<std::size_t>(p)]];
    return sum;
  }
  /// Per patch, the product of its parts of two vectors.
  template <typename Vector>
  void multiply_patches(const Vector& a, const Vector& b, Vector& sums) const {
    sums.resize(static_cast<Eigen::Index>(patches()));
    for (std::size_t k = 0; k < patches(); ++k) {
      const std::int32_t begin = patch_start_[k];
      const std::int32_t size = patch_start_[k + 1] - begin;
      sums[static_cast<Eigen::Index>(k)] = a.segment(begin, size).dot(b.segment(begin, size));
    }
  }
  /// solved = (W^T M W)^-1 W^T v, or (W^T M W)^-1 W^T M v.
  void solve_smooth(const Eigen::VectorXf& v, Work& work) const;
  void solve_smooth_of_product(const Eigen::VectorXf& v, Work& work) const;
  /// to = v + part W coarse.
  void add_smooth(const Eigen::VectorXf& v, float part, const Eigen::VectorXf& coarse, Eigen::VectorXf& to) const;
  void subtract_product_of_smooth(const Eigen::VectorXf& coarse, Eigen::VectorXf& v) const;
  void iterate(Work& work) const;

  Eigen::Index rows_ = 0;
  // Rows patch by patch, so that a patch is a range and its rows are read together.
  std::vector<std::int32_t> row_of_;       ///< of C
  Eigen::VectorXf root_;                   ///< D^-1/2
  std::vector<std::int32_t> start_, col_;  ///< both triangles without the diagonal, which is 1
  std::vector<float> value_;
  std::vector<std::int32_t> patch_start_{0};
  Eigen::VectorXf weight_;             ///< of each row in its column of W, in the scaled unknowns: D^1/2
  Eigen::VectorXf near_;               ///< M W of each row in its own patch
  std::vector<Far> far_;               ///< and in others
  Eigen::MatrixXf coarse_;             ///< (W^T M W)^-1
  float centre_ = 1, half_width_ = 0;  ///< of the interval that holds the eigenvalues
  int steps_ = 1;
};

}  // namespace rhexis::linalg
