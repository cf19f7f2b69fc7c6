#include "response/force_basis.h"

namespace rhexis::response {
namespace {

/// What a force has beyond the directions that are known, below this part of it, is rounding.
constexpr double kSameDirection = 1e-14;

}  // namespace

void ForceBasis::displacement(const VectorX& held_forces, const Solve& solve, VectorX& out) {
  if (!known_) {
    solve(VectorX::Zero(held_forces.size()), 1.0, rest_);
    force_.resize(held_forces.size(), 0);
    moved_.resize(rest_.size(), 0);
    known_ = true;
  }
  for (;;) {
    out = rest_;
    VectorX left = held_forces;
    for (Eigen::Index column = 0; column < force_.cols(); ++column) {
      const double part = force_.col(column).dot(left);
      left -= part * force_.col(column);
      out += part * moved_.col(column);
    }
    const double more = left.norm();
    if (!(more > kSameDirection * held_forces.norm())) return;
    // As many as there can be: rounding has made some depend on others.
    const Eigen::Index column = force_.cols() < held_forces.size() ? force_.cols() : 0;
    const VectorX direction = column == 0 ? VectorX(held_forces.normalized()) : VectorX(left / more);
    VectorX moved;
    solve(direction, 0.0, moved);
    force_.conservativeResize(Eigen::NoChange, column + 1);
    moved_.conservativeResize(Eigen::NoChange, column + 1);
    force_.col(column) = direction;
    moved_.col(column) = moved;
  }
}

}  // namespace rhexis::response
