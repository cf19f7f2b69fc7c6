#pragma once

/// Newton's method at one load fraction (section 4.3 of the paper, with line search and inversion control).

#include <memory>
#include <optional>
#include <vector>

#include "linalg/saddle_solver.h"
#include "model/loading.h"
#include "model/model.h"
#include "solver/equilibrium.h"
#include "solver/options.h"

namespace rhexis::solver {

/// Tolerances of the iteration that are ours, not the user's.
/// A correction below this fraction of the unknowns no longer moves the state: the residual has reached rounding when
/// it does not fall either. No unit.
inline constexpr double kRoundingCorrection = 1e-11;
/// Nor does one below this fraction of the largest coordinate: x = X + u cannot hold it. A few units in the last place.
inline constexpr double kRoundingMove = 1e-15;
/// Stagnation above this relative residual is no convergence: the numbers are too far apart in size for the arithmetic.
inline constexpr double kLargestStagnation = 1e-6;
/// The residual may grow by this factor in a full Newton step before the step is shortened: in bending, the first step
/// turns into stretch, whose residual is large and vanishes in the next.
inline constexpr double kResidualGrowth = 4.0;
/// Relative residuals that iterative linear solvers are asked for: between these, and a factor below what is needed.
inline constexpr double kLoosestForcing = 1e-2;
inline constexpr double kTightestForcing = 1e-10;
inline constexpr double kForcingSafety = 0.3;
/// A step is halved at most this often in the line search.
inline constexpr int kMaxHalvings = 8;

/// One body under one loading: holds the tangent, the factor and all work space, so that iterations do not allocate.
class Newton {
 public:
  Newton(const model::Model& model, const model::Loading& loading, const Options& options);

  /// Moves `state` to equilibrium at load fraction t. On failure `state` is left wherever the iteration was.
  StepReport solve(double t, model::State& state);

  /// Of the last tangent; empty when the linear solver cannot know.
  [[nodiscard]] std::optional<int> negative_pivots() const { return negative_pivots_; }
  /// Force of the supports on the body at a state in equilibrium at t, N; zero on free dofs.
  [[nodiscard]] VectorX reaction(double t, const model::State& state);
  [[nodiscard]] double build_seconds() const { return build_seconds_; }
  [[nodiscard]] double solve_seconds() const { return solve_seconds_; }
  [[nodiscard]] std::size_t linear_memory_bytes() const { return linear_->memory_bytes(); }

 private:
  /// Sizes of the two residuals, relative (section 1.4), and of the first as it is, which the line search watches: it
  /// compares states of one step, between which the scales change.
  struct Norms {
    double u = 0.0;
    double lambda = 0.0;
    double force = 0.0;  ///< |R_u| on the free dofs, N
  };

  model::Evaluation evaluate(double t, const model::State& state);
  [[nodiscard]] Norms norms(const model::State& state) const;
  [[nodiscard]] double free_residual() const;
  /// The residual that moving every node by its last place makes, N: below it there is nothing to converge.
  [[nodiscard]] double force_of_rounding() const;
  linalg::LinearReport find_direction(double t, const model::State& state, const VectorX& held_increment,
                                      double tolerance);
  void build_tangent(double t, const model::State& state);

  const model::Model& model_;
  const model::Loading& loading_;
  const Options& options_;
  linalg::FreeDofs free_;
  linalg::BlockPreconditioner blocks_;
  std::unique_ptr<linalg::SaddleSolver> linear_;
  std::unique_ptr<model::Scratch> scratch_;
  linalg::SaddleMatrix tangent_;
  bool tangent_is_constant_ = false;  ///< a linear model without follower pressure is factored once
  bool factored_ = false;
  double smallest_move_ = 0.0;  ///< m, kRoundingMove of the body

  model::Residual residual_;  ///< internal minus external force, and R_lambda
  VectorX external_;          ///< N, at the last evaluation
  VectorX internal_;          ///< N, at the last evaluation
  VectorX held_;              ///< increments of the held dofs still to be made, m
  VectorX du_, dlambda_;      ///< the Newton direction
  VectorX rhs_u_, rhs_lambda_;
  model::State trial_;
  std::optional<int> negative_pivots_;
  double build_seconds_ = 0.0;
  double solve_seconds_ = 0.0;
};

}  // namespace rhexis::solver
