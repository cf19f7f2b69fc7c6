#include "linalg/direct_solver.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <utility>

#include "base/check.h"
#include "linalg/linear_reports.h"
#include "linalg/null_pivot.h"
#include "linalg/ordering.h"

namespace rhexis::linalg {
namespace {

constexpr int kMostRefinements = 3;
/// Not below: the rounding of K x itself.
constexpr double kBestResidual = 8.0 * std::numeric_limits<double>::epsilon();
/// A residual that refinement leaves above this means that the factor is worthless.
constexpr double kWorstResidual = 1e-6;

}  // namespace

DirectSolver::Assembled::Assembled(const SaddleMatrix& K, const FreeDofs& free, bool general)
    : triplets(K, free, general), factor(general ? MumpsFactor::Kind::general : MumpsFactor::Kind::symmetric) {
  const std::vector<std::int32_t> order = find_order(make_graph(K, free), Ordering::metis);
  place.resize(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    place[static_cast<std::size_t>(order[i])] = static_cast<std::int32_t>(i) + 1;
  }
}

LinearReport DirectSolver::factor(const SaddleMatrix& K, const FreeDofs& free) {
  K_ = &K;
  method_ = Method::none;
  negative_pivots_.reset();
  if (!key_.matches(K, free)) {
    key_ = SystemKey(K, free);
    cholesky_.reset();
    assembled_.reset();
  }
  if (!is_finite(K)) return bad_matrix();
  residual_.set_system(K, key_.free());
  if (K.pressure_unknowns() > 0 || K.skew) return factor_assembled(false);

  switch (try_cholesky()) {
    case CholeskyOutcome::ok: break;
    case CholeskyOutcome::not_positive_definite: return factor_assembled(true);
    case CholeskyOutcome::out_of_memory: return out_of_memory(K);
  }
  if (cholesky_->smallest_pivot() < null_pivot(key_.free().count())) {
    return failure(LinearOutcome::singular, fmt::format("the matrix is singular: {}", kSingularHelp));
  }
  method_ = Method::cholesky;
  negative_pivots_ = 0;
  LinearReport report;
  report.negative_pivots = negative_pivots_;
  return report;
}

CholeskyOutcome DirectSolver::try_cholesky() {
  if (!cholesky_) {
    cholesky_.emplace();
    const BlockPattern none = make_block_pattern(0, {}, 1);
    const CholeskyOutcome outcome = cholesky_->analyse(K_->A.pattern ? *K_->A.pattern : none, key_.free());
    if (outcome != CholeskyOutcome::ok) {
      cholesky_.reset();
      return outcome;
    }
  }
  return cholesky_->factor(K_->A.values);
}

LinearReport DirectSolver::factor_assembled(bool was_indefinite) {
  const bool general = K_->skew.has_value();
  const bool is_new = !assembled_;
  if (is_new) assembled_.emplace(*K_, key_.free(), general);
  Assembled& a = *assembled_;
  LinearReport report;
  method_ = Method::mumps;
  if (a.triplets.size() == 0) return report;
  a.triplets.gather(*K_, a.values);
  MumpsOutcome outcome = MumpsOutcome::ok;
  if (is_new) outcome = a.factor.analyse(a.triplets.size(), a.triplets.rows(), a.triplets.columns(), a.place);
  if (outcome == MumpsOutcome::ok) outcome = a.factor.factor(a.values);
  if (outcome != MumpsOutcome::ok) {
    method_ = Method::none;
    if (outcome == MumpsOutcome::out_of_memory) {
      assembled_.reset();
      return out_of_memory(*K_);
    }
    return failure(LinearOutcome::singular, fmt::format("the matrix is singular, {} pivot(s) vanish: {}",
                                                        a.factor.null_pivots(), kSingularHelp));
  }
  if (!general) {
    negative_pivots_ = a.factor.negative_pivots() - K_->pressure_unknowns();
    report.negative_pivots = negative_pivots_;
  }
  if (was_indefinite) {
    report.message = fmt::format(
        "the stiffness is not positive definite, {} negative pivot(s): factored as L D L^T instead of Cholesky",
        *negative_pivots_);
  }
  return report;
}

void DirectSolver::add_correction(VectorX& xu, VectorX& xp) {
  if (method_ == Method::cholesky) {
    correction_.resize(xu.size());
    cholesky_->solve(residual_.u(), correction_);
    xu += correction_;
    return;
  }
  Assembled& a = *assembled_;
  if (a.triplets.size() == 0) return;
  const FreeDofs& free = key_.free();
  a.right.resize(a.triplets.size());
  for (std::int32_t i = 0; i < free.count(); ++i) a.right[i] = residual_.u()[free.dof[static_cast<std::size_t>(i)]];
  a.right.tail(xp.size()) = residual_.p();
  a.factor.solve(a.right);
  for (std::int32_t i = 0; i < free.count(); ++i) xu[free.dof[static_cast<std::size_t>(i)]] += a.right[i];
  xp += a.right.tail(xp.size());
}

LinearReport DirectSolver::solve(const VectorX& bu, const VectorX& bp, double tolerance, VectorX& xu, VectorX& xp) {
  RHEXIS_CHECK(method_ != Method::none, "solve without a factor");
  xu.setZero(bu.size());
  xp.setZero(bp.size());
  LinearReport report;
  report.negative_pivots = negative_pivots_;
  if (!is_finite(key_.free(), bu, bp)) {
    return bad_right_hand_side();
  }
  const double norm = residual_.norm(bu, bp);
  if (norm == 0.0) return report;

  const double enough = norm * std::max(tolerance, kBestResidual);
  double last = residual_.measure(bu, bp, xu, xp);
  for (int round = 0; round <= kMostRefinements; ++round) {
    add_correction(xu, xp);
    const double now = residual_.measure(bu, bp, xu, xp);
    const bool stalls = now > 0.5 * last;
    last = now;
    if (now <= enough || stalls) break;
  }
  report.relative_residual = last / norm;
  if (!std::isfinite(last)) {
    return failure(LinearOutcome::singular,
                   fmt::format("the solution is not finite, so the matrix is singular: {}", kSingularHelp));
  }
  if (report.relative_residual > std::max(tolerance, kWorstResidual)) {
    report.outcome = LinearOutcome::not_converged;
    report.message =
        fmt::format("refinement stops at a relative residual of {:.1e}, so the matrix is close to singular: {}",
                    report.relative_residual, kSingularHelp);
  }
  return report;
}

std::size_t DirectSolver::memory_bytes() const {
  std::size_t bytes = 0;
  if (cholesky_) bytes += cholesky_->memory_bytes();
  if (assembled_) {
    bytes += assembled_->factor.memory_bytes() + assembled_->triplets.memory_bytes() +
             sizeof(double) * assembled_->values.capacity() + sizeof(std::int32_t) * assembled_->place.capacity();
  }
  return bytes;
}

}  // namespace rhexis::linalg
