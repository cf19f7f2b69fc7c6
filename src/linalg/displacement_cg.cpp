#include "linalg/displacement_cg.h"

#include "base/check.h"
#include "linalg/linear_reports.h"
#include "linalg/measured_iteration.h"

namespace rhexis::linalg {
namespace {

constexpr int kMaxIterations = 20000;
constexpr std::string_view kOperator = "the stiffness";

}  // namespace

LinearReport DisplacementCg::factor(const SaddleMatrix& K, const FreeDofs& free) {
  K_ = nullptr;
  if (!is_finite(K)) return bad_matrix();
  free_ = free;
  residual_.set_system(K, free_);
  if (K.A.rows() > 0 && !preconditioner_.factor(K.A, free_)) return indefinite(kOperator);
  K_ = &K;
  return {};
}

LinearReport DisplacementCg::solve(const VectorX& bu, const VectorX& bp, double tolerance, VectorX& xu, VectorX& xp) {
  RHEXIS_CHECK(K_ != nullptr, "solve without a factor");
  xu.setZero(bu.size());
  xp.setZero(bp.size());
  if (!is_finite(free_, bu, bp)) return bad_right_hand_side();
  const double norm = residual_.norm(bu, bp);
  if (norm == 0.0) return {};
  work_.resize(bu.size());
  const auto apply = [&](const VectorX& x, VectorX& y) {
    K_->A.multiply(x, y);
    clear_held(free_, y);
  };
  const auto precondition = [&](const VectorX& r, VectorX& z) { preconditioner_.solve(r, z); };
  const auto run = [&](int most) {
    r_ = residual_.u();
    return conjugate_gradients(apply, precondition, tolerance * norm, most, work_, r_, xu);
  };
  return iterate_measured(residual_, bu, bp, norm, tolerance, kMaxIterations, kOperator, run, xu, xp);
}

}  // namespace rhexis::linalg
