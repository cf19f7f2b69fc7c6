#include "solver/newton.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/clock.h"

namespace rhexis::solver {
namespace {

/// 0 / 0 is 0: nothing is wrong with a body on which nothing acts.
double ratio(double value, double scale) {
  if (value == 0.0) return 0.0;
  return scale > 0.0 ? value / scale : std::numeric_limits<double>::infinity();
}

std::string tet_name(TetId tet) { return tet.valid() ? fmt::format("tet {}", tet.value()) : std::string("a tet"); }

}  // namespace

Newton::Newton(const model::Model& model, const model::Loading& loading, const Options& options)
    : model_(model), loading_(loading), options_(options), free_(model::free_dofs(model.space(), loading)) {
  if (options.linear == "minres") blocks_ = model.preconditioner();
  linear_ = linalg::make_saddle_solver(options.linear, &blocks_);
  scratch_ = model.make_scratch();
  tangent_ = model.make_tangent();
  tangent_is_constant_ = model.is_linear() && loading.pressures.empty();
  const auto dofs = static_cast<Eigen::Index>(model.space().dof_count());
  const auto pressures = static_cast<Eigen::Index>(model.pressure_unknowns());
  for (VectorX* vector : {&residual_.u, &external_, &internal_, &held_, &du_, &rhs_u_}) vector->setZero(dofs);
  for (VectorX* vector : {&residual_.lambda, &dlambda_, &rhs_lambda_}) vector->setZero(pressures);
  trial_ = {VectorX::Zero(dofs), VectorX::Zero(pressures)};
  double size = 0.0;
  for (const Vec3& x : model.space().nodes) size = std::max(size, x.lpNorm<Eigen::Infinity>());
  smallest_move_ = kRoundingMove * size;
}

model::Evaluation Newton::evaluate(double t, const model::State& state) {
  const ScopedTimer timer(build_seconds_);
  const model::Evaluation evaluation = model_.residual(state, *scratch_, residual_);
  internal_ = residual_.u;
  model::external_force(loading_, model_.space(), state.u, t, external_);
  residual_.u -= external_;
  return evaluation;
}

Newton::Norms Newton::norms(const model::State& state) const {
  Norms norms;
  norms.force = free_residual();
  norms.u = ratio(norms.force, std::max(internal_.norm(), external_.norm()));
  norms.lambda = residual_.lambda.size() == 0 ? 0.0 : ratio(residual_.lambda.norm(), model_.volume_change_norm(state));
  return norms;
}

void Newton::build_tangent(double t, const model::State& state) {
  const ScopedTimer timer(build_seconds_);
  model_.tangent(state, *scratch_, tangent_);
  model::subtract_load_stiffness(loading_, model_.space(), state.u, t, tangent_);
}

/// K (du, dlambda) = -(R_u, R_lambda) with du = held_increment on the held dofs.
linalg::LinearReport Newton::find_direction(double t, const model::State& state, const VectorX& held_increment,
                                            double tolerance) {
  const bool reuse = tangent_is_constant_ && factored_;
  if (!reuse) build_tangent(t, state);
  const ScopedTimer timer(solve_seconds_);
  linalg::LinearReport report;
  if (!reuse) {
    report = linear_->factor(tangent_, free_);
    if (!report.ok()) return report;
    factored_ = true;
    negative_pivots_ = report.negative_pivots;
  }
  dlambda_.setZero();
  tangent_.multiply(held_increment, dlambda_, rhs_u_, rhs_lambda_);
  rhs_u_ = -residual_.u - rhs_u_;
  rhs_lambda_ = -residual_.lambda - rhs_lambda_;
  report = linear_->solve(rhs_u_, rhs_lambda_, tolerance, du_, dlambda_);
  for (const model::PrescribedDof& support : loading_.supports) du_[support.dof] = held_increment[support.dof];
  return report;
}

StepReport Newton::solve(double t, model::State& state) {
  StepReport step;
  step.load = t;
  for (const model::PrescribedDof& support : loading_.supports)
    held_[support.dof] = t * support.value - state.u[support.dof];
  bool held_in_place = held_.isZero(0.0);

  model::Evaluation evaluation = evaluate(t, state);
  Norms now = norms(state);
  double forcing = kLoosestForcing;
  int idle = 0;
  for (;; ++step.iterations) {
    step.residual_u = now.u;
    step.residual_lambda = now.lambda;
    if (!evaluation.finite) {
      step.outcome = Outcome::not_finite;
      step.message = fmt::format("the force of {} is not finite", tet_name(evaluation.worst_tet));
      return step;
    }
    // A step has at least one iteration: a small one starts below the tolerance, and the load would move without the
    // body.
    const bool within = now.u <= options_.tolerance && now.lambda <= options_.tolerance;
    if (held_in_place && within && step.iterations > 0) return step;
    if (step.iterations == options_.max_iterations) {
      step.outcome = Outcome::too_many_iterations;
      step.message = fmt::format("no equilibrium after {} iterations, relative residual {:.1e}", step.iterations,
                                 std::max(now.u, now.lambda));
      return step;
    }

    const linalg::LinearReport linear = find_direction(t, state, held_, forcing);
    step.linear_iterations += linear.iterations;
    if (!linear.ok()) {
      step.outcome = Outcome::linear_solver;
      step.message = linear.message;
      step.smaller_may_help = linear.outcome != linalg::LinearOutcome::not_supported;
      return step;
    }

    // Line search: shorten while a tet inverts, a force is not finite, or the residual grows too much. The step that
    // brings the supports into place is judged by the first two alone: it starts from no equilibrium.
    double alpha = 1.0;
    Norms next;
    for (int halving = 0;; ++halving) {
      trial_.u = state.u + alpha * du_;
      trial_.lambda = state.lambda + alpha * dlambda_;
      evaluation = evaluate(t, trial_);
      next = norms(trial_);
      const bool admissible = evaluation.finite && (model_.allows_inversion() || evaluation.inverted_tets == 0);
      const bool small_enough = step.iterations == 0 || !held_in_place || next.force <= kResidualGrowth * now.force ||
                                next.u <= options_.tolerance;
      if (admissible && (small_enough || halving == kMaxHalvings)) break;
      if (halving == kMaxHalvings) {
        step.outcome = evaluation.finite ? Outcome::inverted : Outcome::not_finite;
        step.message = evaluation.finite
                           ? fmt::format("tets turn inside out: {}, {} first (J = {:.3g})", evaluation.inverted_tets,
                                         tet_name(evaluation.worst_tet), evaluation.min_J)
                           : fmt::format("the force of {} is not finite", tet_name(evaluation.worst_tet));
        return step;
      }
      alpha *= 0.5;
    }

    // Rounding: the correction no longer moves the state and the residual no longer falls.
    const double moved =
        std::max(ratio(alpha * du_.norm(), trial_.u.norm()), ratio(alpha * dlambda_.norm(), trial_.lambda.norm()));
    const bool at_rounding = moved <= kRoundingCorrection || alpha * du_.lpNorm<Eigen::Infinity>() <= smallest_move_;
    const bool falls = next.u < 0.5 * now.u || next.lambda < 0.5 * now.lambda;
    idle = at_rounding && !falls ? idle + 1 : 0;

    // Eisenstat and Walker's second choice keeps iterative solvers from solving a wrong model exactly; nor need the
    // last iteration go far below the tolerance.
    const double worst = std::max(next.u, next.lambda);
    const double reduction = ratio(worst, std::max(now.u, now.lambda));
    const double enough = ratio(kForcingSafety * options_.tolerance, worst);
    forcing =
        !std::isfinite(worst) || !std::isfinite(reduction)
            ? kLoosestForcing
            : std::clamp(std::max(kForcingSafety * reduction * reduction, enough), kTightestForcing, kLoosestForcing);

    std::swap(state, trial_);
    now = next;
    if (alpha == 1.0) {
      held_.setZero();
      held_in_place = true;
    } else {
      held_ *= 1.0 - alpha;
    }
    if (idle >= 2 && (worst <= kLargestStagnation || free_residual() <= force_of_rounding())) {
      ++step.iterations;
      step.residual_u = now.u;
      step.residual_lambda = now.lambda;
      step.outcome = Outcome::stagnated;
      step.message =
          fmt::format("at rounding: relative residual {:.1e}, above the tolerance {:.1e}", worst, options_.tolerance);
      return step;
    }
  }
}

double Newton::free_residual() const {
  double square = 0.0;
  for (const std::int32_t dof : free_.dof) square += residual_.u[dof] * residual_.u[dof];
  return std::sqrt(square);
}

double Newton::force_of_rounding() const {
  double stiffest = 0.0;
  const linalg::SymmetricBlockMatrix& A = tangent_.A;
  for (std::int32_t row = 0; row < A.rows(); ++row) {
    const auto block = static_cast<std::size_t>(A.pattern->row_start[static_cast<std::size_t>(row) + 1]) - 1;
    for (const std::size_t c : {0U, 4U, 8U}) stiffest = std::max(stiffest, std::abs(A.values[9 * block + c]));
  }
  return stiffest * smallest_move_ * std::sqrt(static_cast<double>(free_.count()));
}

VectorX Newton::reaction(double t, const model::State& state) {
  evaluate(t, state);
  VectorX reaction = VectorX::Zero(residual_.u.size());
  for (const model::PrescribedDof& support : loading_.supports) reaction[support.dof] = residual_.u[support.dof];
  return reaction;
}

}  // namespace rhexis::solver
