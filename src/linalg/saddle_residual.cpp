#include "linalg/saddle_residual.h"

#include <cmath>
#include <span>

namespace rhexis::linalg {
namespace {

/// x * 0 is 0 for a number and NaN for anything else, which the sum keeps.
bool all_finite(std::span<const double> values) {
  double sum = 0.0;
  for (const double value : values) sum += value * 0.0;
  return sum == 0.0;
}

template <typename Vectors>
void clear_held_rows(const FreeDofs& free, Vectors& u) {
  for (std::size_t dof = 0; dof < free.index.size(); ++dof) {
    if (free.index[dof] < 0) u.row(static_cast<Eigen::Index>(dof)).setZero();
  }
}

}  // namespace

void SaddleResidual::set_system(const SaddleMatrix& K, const FreeDofs& free) {
  K_ = &K;
  free_ = &free;
  u_.resize(K.displacement_unknowns());
  p_.resize(K.pressure_unknowns());
  scale_.setOnes(K.pressure_unknowns());
  double stiffness = 0.0;
  for (const std::int32_t dof : free.dof) {
    const auto row = static_cast<std::size_t>(dof / 3);
    const auto diagonal = static_cast<std::size_t>(K.A.pattern->row_start[row + 1]) - 1;
    stiffness += std::abs(K.A.values[9 * diagonal + static_cast<std::size_t>(4 * (dof % 3))]);
  }
  if (stiffness == 0.0) return;
  stiffness /= free.count();
  for (std::int32_t p = 0; p < K.pressure_unknowns(); ++p) {
    const double c = K.C.values[static_cast<std::size_t>(K.C.pattern->row_start[static_cast<std::size_t>(p) + 1]) - 1];
    if (c > 0.0) scale_[p] = std::sqrt(stiffness / c);
  }
}

double SaddleResidual::norm(const VectorX& bu, const VectorX& bp) const {
  double sum = 0.0;
  for (const std::int32_t dof : free_->dof) sum += bu[dof] * bu[dof];
  for (Eigen::Index i = 0; i < scale_.size(); ++i) {
    const double scaled = scale_[i] * bp[i];
    sum += scaled * scaled;
  }
  return std::sqrt(sum);
}

double SaddleResidual::measure(const VectorX& bu, const VectorX& bp, const VectorX& xu, const VectorX& xp) {
  K_->multiply(xu, xp, u_, p_);
  u_ = bu - u_;
  if (p_.size() > 0) p_ = bp - p_;
  clear_held(*free_, u_);
  return norm(u_, p_);
}

bool is_finite(const SaddleMatrix& K) {
  return all_finite(K.A.values) && all_finite(K.B.values) && all_finite(K.C.values) &&
         (!K.skew || all_finite(K.skew->values));
}

bool is_finite(const FreeDofs& free, const VectorX& bu, const VectorX& bp) {
  double sum = 0.0;
  for (const std::int32_t dof : free.dof) sum += bu[dof] * 0.0;
  return sum == 0.0 && all_finite({bp.data(), static_cast<std::size_t>(bp.size())});
}

void clear_held(const FreeDofs& free, VectorX& u) { clear_held_rows(free, u); }
void clear_held(const FreeDofs& free, TwoLanes& u) { clear_held_rows(free, u); }
void clear_held(const FreeDofs& free, FourLanes& u) { clear_held_rows(free, u); }

}  // namespace rhexis::linalg
