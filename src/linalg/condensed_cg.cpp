#include "linalg/condensed_cg.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "linalg/linear_reports.h"
#include "linalg/measured_iteration.h"

namespace rhexis::linalg {
namespace {

constexpr int kMaxIterations = 2000;
/// A preconditioner of an earlier matrix is given up when a decade of the residual costs this many times the iterations
/// that it cost at first: a factorisation costs about as much as the solves of ten to twenty iterations.
constexpr double kWorn = 1.5;
constexpr std::string_view kOperator = "the stiffness with the pressures eliminated";

}  // namespace

LinearReport CondensedCg::factor(const SaddleMatrix& K, const FreeDofs& free) {
  K_ = nullptr;
  if (!is_finite(K)) return bad_matrix();
  const bool same_system = key_.matches(K, free);
  if (!same_system) {
    key_ = SystemKey(K, free);
    c_factor_.reset();
  }
  residual_.set_system(K, key_.free());
  CholeskyOutcome outcome = take_c(K);
  if (outcome == CholeskyOutcome::not_positive_definite) return indefinite("the pressure block");
  if (outcome == CholeskyOutcome::ok && !same_system) outcome = preconditioner_.analyse(K, key_.free());
  preconditioner_kept_ = outcome == CholeskyOutcome::ok && same_system && !preconditioner_worn_;
  if (outcome == CholeskyOutcome::ok && !preconditioner_kept_) outcome = preconditioner_.factor(K, key_.free());
  preconditioner_worn_ = outcome != CholeskyOutcome::ok;
  if (outcome == CholeskyOutcome::not_positive_definite) return indefinite(kOperator);
  if (outcome == CholeskyOutcome::out_of_memory) {
    key_ = {};
    return out_of_memory(K);
  }
  K_ = &K;
  return {};
}

CholeskyOutcome CondensedCg::take_c(const SaddleMatrix& K) {
  const SymmetricCsr& C = K.C;
  if (c_factor_ && c_values_ == C.values) return CholeskyOutcome::ok;
  CholeskyOutcome outcome = CholeskyOutcome::ok;
  if (!c_factor_) outcome = c_factor_.emplace().analyse(*C.pattern);
  if (outcome == CholeskyOutcome::ok) outcome = c_factor_->factor(C.values);
  if (outcome != CholeskyOutcome::ok) {
    c_factor_.reset();
    return outcome;
  }
  c_values_ = C.values;
  preconditioner_.set_c(K, *c_factor_);
  preconditioner_worn_ = true;
  return outcome;
}

LinearReport CondensedCg::solve(const VectorX& bu, const VectorX& bp, double tolerance, VectorX& xu, VectorX& xp) {
  RHEXIS_CHECK(K_ != nullptr, "solve without a factor");
  xu.setZero(bu.size());
  xp.setZero(bp.size());
  const FreeDofs& free = key_.free();
  if (!is_finite(free, bu, bp)) return bad_right_hand_side();
  const double norm = residual_.norm(bu, bp);
  if (norm == 0.0) return {};
  work_.resize(bu.size());
  p_.resize(bp.size());
  q_.resize(bp.size());

  LinearReport report = iterate(bu, bp, norm, tolerance, xu, xp);
  if (!report.ok() && preconditioner_kept_) {
    const CholeskyOutcome outcome = preconditioner_.factor(*K_, free);
    if (outcome != CholeskyOutcome::ok) {
      preconditioner_worn_ = true;
      return outcome == CholeskyOutcome::out_of_memory ? out_of_memory(*K_) : indefinite(kOperator);
    }
    preconditioner_kept_ = false;
    xu.setZero();
    xp.setZero();
    report = iterate(bu, bp, norm, tolerance, xu, xp);
  }
  const double cost = report.iterations / std::max(1.0, -std::log10(tolerance));
  if (preconditioner_kept_) {
    preconditioner_worn_ = cost > kWorn * new_cost_ + 1.0;
  } else {
    new_cost_ = cost;
  }
  return report;
}

LinearReport CondensedCg::iterate(const VectorX& bu, const VectorX& bp, double norm, double tolerance, VectorX& xu,
                                  VectorX& xp) {
  const FreeDofs& free = key_.free();
  const auto apply = [&](const VectorX& x, VectorX& y) {
    K_->A.multiply(x, y);
    K_->B.multiply(x, q_);
    c_factor_->solve(q_, p_);
    K_->B.add_transposed(p_, 1.0, y);
    clear_held(free, y);
  };
  const auto precondition = [&](const VectorX& r, VectorX& z) { preconditioner_.solve(r, z); };
  const auto run = [&](int most) {
    // For the correction: S du = ru + B C^-1 rp, dp = C^-1 (B^T du - rp).
    const VectorX& rp = residual_.p();
    c_factor_->solve(rp, p_);
    r_ = residual_.u();
    K_->B.add_transposed(p_, 1.0, r_);
    clear_held(free, r_);
    const VectorX before = xu;
    const CgResult result = conjugate_gradients(apply, precondition, tolerance * norm, most, work_, r_, xu);
    work_.z = xu - before;
    K_->B.multiply(work_.z, q_);
    q_ -= rp;
    c_factor_->solve(q_, p_);
    xp += p_;
    return result;
  };
  return iterate_measured(residual_, bu, bp, norm, tolerance, kMaxIterations, kOperator, run, xu, xp);
}

std::size_t CondensedCg::memory_bytes() const {
  return preconditioner_.memory_bytes() + (c_factor_ ? c_factor_->memory_bytes() : 0) +
         sizeof(double) * (c_values_.capacity() + static_cast<std::size_t>(4 * r_.size() + 2 * p_.size()));
}

}  // namespace rhexis::linalg
