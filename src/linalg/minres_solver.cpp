#include "linalg/minres_solver.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/check.h"
#include "linalg/linear_reports.h"

namespace rhexis::linalg {
namespace {

constexpr int kMaxIterations = 5000;

/// y = a x + b y + c z, with the result in place of y.
void combine(double a, const SaddleVector& x, double b, SaddleVector& y, double c, const SaddleVector& z) {
  y.u = a * x.u + b * y.u + c * z.u;
  y.p = a * x.p + b * y.p + c * z.p;
}

}  // namespace

LinearReport MinresSolver::factor(const SaddleMatrix& K, const FreeDofs& free) {
  K_ = nullptr;
  if (K.skew) return skew_not_supported("minres");
  if (!is_finite(K)) return bad_matrix();
  if (!key_.matches(K, free)) {
    key_ = SystemKey(K, free);
    const LinearReport report = factor_blocks(K);
    if (!report.ok()) {
      key_ = {};
      return report;
    }
  }
  residual_.set_system(K, key_.free());
  K_ = &K;
  return {};
}

LinearReport MinresSolver::factor_blocks(const SaddleMatrix& K) {
  RHEXIS_CHECK(blocks_.A0.rows() == K.A.rows(), "A0 has {} rows, A {}", blocks_.A0.rows(), K.A.rows());
  const bool finite = is_finite(SaddleMatrix{blocks_.A0, {}, blocks_.S0, {}});
  if (!finite) return bad_matrix();
  a_factor_.emplace();
  s_factor_.emplace();
  CholeskyOutcome outcome = CholeskyOutcome::ok;
  if (K.A.rows() > 0) {
    outcome = a_factor_->analyse(*blocks_.A0.pattern, key_.free());
    if (outcome == CholeskyOutcome::ok) outcome = a_factor_->factor(blocks_.A0.values);
  }
  if (outcome == CholeskyOutcome::ok && K.pressure_unknowns() > 0) {
    RHEXIS_CHECK(blocks_.S0.rows() == K.pressure_unknowns(), "S0 has {} rows, C {}", blocks_.S0.rows(),
                 K.pressure_unknowns());
    outcome = s_factor_->analyse(*blocks_.S0.pattern);
    if (outcome == CholeskyOutcome::ok) outcome = s_factor_->factor(blocks_.S0.values);
  }
  if (outcome == CholeskyOutcome::ok) return {};
  if (outcome == CholeskyOutcome::out_of_memory) return out_of_memory(K);
  return failure(LinearOutcome::singular,
                 fmt::format("the stiffness at rest, by which minres preconditions, is singular: {}", kSingularHelp));
}

void MinresSolver::apply(const SaddleVector& x, SaddleVector& y) const {
  K_->multiply(x.u, x.p, y.u, y.p);
  clear_held(key_.free(), y.u);
}

void MinresSolver::precondition(const SaddleVector& v, SaddleVector& z) {
  if (v.u.size() > 0) a_factor_->solve(v.u, z.u);
  if (v.p.size() > 0) s_factor_->solve(v.p, z.p);
}

LinearReport MinresSolver::solve(const VectorX& bu, const VectorX& bp, double tolerance, VectorX& xu, VectorX& xp) {
  RHEXIS_CHECK(K_ != nullptr, "solve without a factor");
  xu.setZero(bu.size());
  xp.setZero(bp.size());
  if (!is_finite(key_.free(), bu, bp)) return bad_right_hand_side();
  LinearReport report;
  const double norm = residual_.norm(bu, bp);
  if (norm == 0.0) return report;

  for (SaddleVector* vector : {&v_, &v_before_, &v_next_, &z_, &z_next_, &w_, &w_before_, &w_next_}) {
    vector->set_zero(bu.size(), bp.size());
  }
  v_.u = bu;
  v_.p = bp;
  clear_held(key_.free(), v_.u);
  precondition(v_, z_);
  double gamma = std::sqrt(z_.dot(v_));  // norms of the residual in the metric of the preconditioner
  double gamma_before = 1.0;
  double eta = gamma;
  double c = 1.0, c_before = 1.0;  // the last two Givens rotations
  double s = 0.0, s_before = 0.0;
  double check_below = gamma * tolerance;  // the true residual is measured when |eta| gets here
  report.relative_residual = 1.0;

  while (report.iterations < kMaxIterations && gamma > 0.0) {
    ++report.iterations;
    // Lanczos: the next vector, orthogonal to all before by three terms
    z_.u /= gamma;
    z_.p /= gamma;
    apply(z_, v_next_);
    const double delta = v_next_.dot(z_);
    combine(-delta / gamma, v_, 1.0, v_next_, -gamma / gamma_before, v_before_);
    precondition(v_next_, z_next_);
    const double gamma_next = std::sqrt(std::max(0.0, z_next_.dot(v_next_)));
    // Givens: the next column of the triangular factor
    const double a0 = c * delta - c_before * s * gamma;
    const double a1 = std::hypot(a0, gamma_next);
    const double a2 = s * delta + c_before * c * gamma;
    const double a3 = s_before * gamma;
    if (a1 == 0.0) break;  // singular, and the right-hand side outside its range
    c_before = std::exchange(c, a0 / a1);
    s_before = std::exchange(s, gamma_next / a1);
    // w_next = (z - a3 w_before - a2 w) / a1
    w_next_.u = (z_.u - a3 * w_before_.u - a2 * w_.u) / a1;
    w_next_.p = (z_.p - a3 * w_before_.p - a2 * w_.p) / a1;
    xu += c * eta * w_next_.u;
    xp += c * eta * w_next_.p;
    eta *= -s;

    std::swap(w_before_, w_);
    std::swap(w_, w_next_);
    std::swap(v_before_, v_);
    std::swap(v_, v_next_);
    std::swap(z_, z_next_);
    gamma_before = std::exchange(gamma, gamma_next);
    if (std::abs(eta) > check_below) continue;
    report.relative_residual = residual_.measure(bu, bp, xu, xp) / norm;
    if (report.relative_residual <= tolerance) return report;
    // The recurrence has run ahead of the truth; go on for what is missing, at least a half.
    check_below = std::abs(eta) * std::min(0.5, tolerance / report.relative_residual);
    if (check_below < 1e-18 * norm) break;
  }
  report.relative_residual = residual_.measure(bu, bp, xu, xp) / norm;
  if (report.relative_residual <= tolerance) return report;
  return not_converged(report, tolerance);
}

std::size_t MinresSolver::memory_bytes() const {
  std::size_t bytes = sizeof(double) * static_cast<std::size_t>(8 * (v_.u.size() + v_.p.size()));
  if (a_factor_) bytes += a_factor_->memory_bytes();
  if (s_factor_) bytes += s_factor_->memory_bytes();
  return bytes;
}

}  // namespace rhexis::linalg
