#pragma once

/// A version of a FrontTree made ready for being solved with often, as a preconditioner is: in single precision, which
/// is half the memory to read, and with its triangular blocks inverted, so that a front is two products of a matrix by
/// a vector,
///
///     W = [L_pp^-1; L_bp L_pp^-1],     (y; s) = W r_p,  r_b -= s,        x_p = W^T (y; -x_b).

#include <cstdint>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include "linalg/front.h"
#include "linalg/front_tree.h"
#include "linalg/lanes.h"

namespace rhexis::linalg {

class FrontSolver {
 public:
  /// Of a version that is factored and keeps no node (RHEXIS_CHECK). `before`: fronts that its version shares are taken
  /// from there. On all threads.
  explicit FrontSolver(const FrontTree& tree, const FrontSolver* before = nullptr);

  struct Work {
    Eigen::VectorXf r, w;  ///< front by front, and lane by lane within
  };
  /// x ~ K^-1 b over all dofs, 3 * node_count, but for rounding in single precision; held dofs and dofs outside the
  /// assembly come out zero, and b is not read there. x may be b. The loads of the elements are not in it. Does not ask
  /// for memory once `work` has been used.
  void solve(const VectorX& b, VectorX& x, Work& work) const;
  void solve(const TwoLanes& b, TwoLanes& x, Work& work) const;
  void solve(const FourLanes& b, FourLanes& x, Work& work) const;
  [[nodiscard]] std::size_t memory_bytes() const;

 private:
  struct Panel;
  /// What a front before this one has left, and where it goes.
  struct Incoming {
    std::int32_t step;  ///< whose boundary the runs count from
    std::int32_t first_run, last_run;
  };
  struct Step {
    std::int32_t pivots, size;
    std::int32_t ld;           ///< size rounded up to whole packets: of its panel, and from lane to lane
    std::int32_t first, work;  ///< where its part of dofs_ begins, and of the work vectors with one lane
    std::int32_t first_incoming, last_incoming;
  };
  template <int k>
  void solve_lanes(const Lanes<k>& b, Lanes<k>& x, Work& work) const;
  template <int k>
  void forward(std::size_t step, const Lanes<k>& b, Work& work) const;
  template <int k>
  void backward(std::size_t step, Lanes<k>& x, Work& work) const;
  template <typename Use>
  void for_each_of_level(std::size_t level, const Use& use) const;

  Eigen::Index size_ = 0;
  std::vector<Step> steps_;  ///< by levels, those first that hand on to no other
  std::vector<std::int32_t> level_start_;
  std::vector<std::int32_t> dofs_;
  Eigen::Index work_size_ = 0;  ///< with one lane
  std::vector<Incoming> incoming_;
  std::vector<Run> runs_;
  std::vector<std::shared_ptr<const Panel>> panels_;  ///< per step
};

}  // namespace rhexis::linalg
