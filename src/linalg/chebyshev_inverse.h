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
#include "linalg/lanes.h"
#include "linalg/saddle_matrix.h"

namespace rhexis::linalg {

class ChebyshevInverse {
 public:
  ChebyshevInverse() = default;
  /// C strictly diagonally dominant with a positive diagonal (RHEXIS_CHECK). `reduction`: of the error, about; 1e-5 and
  /// less is lost in rounding.
  ChebyshevInverse(const SymmetricCsr& C, double reduction);

  [[nodiscard]] int steps() const { return steps_; }
  /// Per patch, by lanes.
  template <int k>
  using Patched = Eigen::Matrix<float, Eigen::Dynamic, k>;
  template <int k>
  struct WorkOf {
    SingleLanes<k> residual, step, x, without_smooth;
    Patched<k> coarse, solved, first;
  };
  struct Work {
    WorkOf<1> one;
    WorkOf<2> two;
    WorkOf<4> four;
  };
  /// x ~ C^-1 b; x may be b.
  void apply(const VectorX& b, VectorX& x, Work& work) const { apply_lanes<1>(b, x, work.one); }
  void apply(const TwoLanes& b, TwoLanes& x, Work& work) const { apply_lanes<2>(b, x, work.two); }
  void apply(const FourLanes& b, FourLanes& x, Work& work) const { apply_lanes<4>(b, x, work.four); }
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
    std::vector<double> value;                             ///< of M, as value_
    Eigen::SparseMatrix<double, Eigen::RowMajor> product;  ///< M W
    Eigen::LLT<Eigen::MatrixXd> coarse;                    ///< of W^T M W
  };
  Scaled take_matrix(const SymmetricCsr& C);
  void take_patches(Scaled& exact);
  [[nodiscard]] double smallest_eigenvalue(const Scaled& exact) const;
  [[nodiscard]] std::size_t patches() const { return patch_start_.size() - 1; }

  /// Per patch, the products of its parts of a and the lanes of b.
  template <typename Vector, typename Many, typename Sums>
  void multiply_patches(const Vector& a, const Many& b, Sums& sums) const {
    sums.resize(static_cast<Eigen::Index>(patches()), b.cols());
    for (std::size_t p = 0; p < patches(); ++p) {
      const std::int32_t begin = patch_start_[p];
      const std::int32_t size = patch_start_[p + 1] - begin;
      sums.row(static_cast<Eigen::Index>(p)).noalias() =
          a.segment(begin, size).transpose().lazyProduct(b.middleRows(begin, size));
    }
  }
  template <int k>
  void apply_lanes(const Lanes<k>& b, Lanes<k>& x, WorkOf<k>& work) const;
  /// solved = (W^T M W)^-1 W^T v, or (W^T M W)^-1 W^T M v.
  template <int k>
  void solve_smooth(const SingleLanes<k>& v, WorkOf<k>& work) const;
  template <int k>
  void solve_smooth_of_product(const SingleLanes<k>& v, WorkOf<k>& work) const;
  /// to = v + part W coarse.
  template <int k>
  void add_smooth(const SingleLanes<k>& v, float part, const Patched<k>& coarse, SingleLanes<k>& to) const;
  template <int k>
  void subtract_product_of_smooth(const Patched<k>& coarse, SingleLanes<k>& v) const;
  template <int k>
  void solve_coarse(WorkOf<k>& work) const {  // lane by lane: narrow products of matrices are slower
    work.solved.resize(work.coarse.rows(), k);
    for (int lane = 0; lane < k; ++lane) work.solved.col(lane).noalias() = coarse_ * work.coarse.col(lane);
  }
  template <int k>
  void iterate(WorkOf<k>& work) const;

  Eigen::Index rows_ = 0;
  // Rows patch by patch, so that a patch is a range and its rows are read together.
  std::vector<std::int32_t> row_of_;  ///< of C
  Eigen::VectorXf root_;              ///< D^-1/2
  // Both triangles without the diagonal, which is 1; as many entries to a row as the fullest has, those that it lacks
  // are zeros on itself: the faces of a tet are four, and a loop of fixed length is twice as fast as one that is not.
  std::size_t width_ = 0;
  std::vector<std::int32_t> col_;
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
