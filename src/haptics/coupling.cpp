#include "haptics/coupling.h"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace rhexis::haptics {
namespace {

/// Newton's method on 1 / |f| from the left, where it is monotone and all but linear: five steps at most were seen.
constexpr int kMostSteps = 30;
/// |f| <= limit (1 + kAtLimit) ends it: rounding of the sum below.
constexpr double kAtLimit = 1e-14;
/// A stiffness below this part of the largest is rounding: along it the body does not resist. The law of a push resists
/// along one direction alone.
constexpr double kNoStiffness = 1e-12;

/// N along each eigenvector, with a spring of 1 / `softness` (softness in m/N).
Vec3 force_with(const FeltLaw& law, const Vec3& beyond, double softness) {
  Vec3 force = Vec3::Zero();
  for (int i = 0; i < 3; ++i)
    if (law.stiffness[i] > 0.0) force[i] = beyond[i] / (softness + 1.0 / law.stiffness[i]);
  return force;
}

/// m/N: that of the spring which gives `limit`, from below up.
double softness_at(const FeltLaw& law, const Vec3& beyond, double softness, double limit) {
  for (int step = 0; step < kMostSteps; ++step) {
    const Vec3 force = force_with(law, beyond, softness);
    const double length = force.norm();
    if (length <= limit * (1.0 + kAtLimit)) break;
    double fall = 0.0;  // -d|f| / d softness, times |f|
    for (int i = 0; i < 3; ++i)
      if (law.stiffness[i] > 0.0) fall += force[i] * force[i] / (softness + 1.0 / law.stiffness[i]);
    softness += (length / limit - 1.0) * length * length / fall;
  }
  return softness;
}

}  // namespace

FeltLaw FeltLaw::make(const Mat3& stiffness, const Vec3& rest, const Vec3& normal, bool pushes_only) noexcept {
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(0.5 * (stiffness + stiffness.transpose()));
  FeltLaw law;
  law.stiffness = solver.eigenvalues();
  const double least = kNoStiffness * law.stiffness.cwiseAbs().maxCoeff();
  for (int i = 0; i < 3; ++i)
    if (!(law.stiffness[i] > least)) law.stiffness[i] = 0.0;
  law.along = solver.eigenvectors();
  law.rest = rest;
  law.normal = normal;
  law.pushes_only = pushes_only;
  return law;
}

Coupled couple(const FeltLaw& law, const Vec3& at, double stiffness, double limit) noexcept {
  Coupled out;
  out.hand = at;
  const Vec3 beyond = law.along.transpose() * (at - law.rest);
  double softness = 1.0 / stiffness;
  Vec3 force = force_with(law, beyond, softness);
  if (law.pushes_only && (law.along * force).dot(law.normal) >= 0.0) return out;
  if (!(limit > 0.0)) {  // the spring gives way to any force, and the body stays at rest
    for (int i = 0; i < 3; ++i)
      if (law.stiffness[i] > 0.0) out.hand -= beyond[i] * law.along.col(i);
    out.limited = true;
    return out;
  }
  double of_spring = 0.5 * softness * force.squaredNorm();
  if (force.norm() > limit) {
    softness = softness_at(law, beyond, softness, limit);
    force = force_with(law, beyond, softness);
    force *= limit / force.norm();
    of_spring = limit * limit * (softness - 0.5 / stiffness);
    out.limited = true;
  }
  out.force = law.along * force;
  out.hand = at - softness * out.force;
  out.energy = of_spring;
  for (int i = 0; i < 3; ++i)
    if (law.stiffness[i] > 0.0) out.energy += 0.5 * force[i] * force[i] / law.stiffness[i];
  return out;
}

Mat3 felt_part(const FeltLaw& law, double stiffness) noexcept {
  Vec3 part;
  for (int i = 0; i < 3; ++i) part[i] = law.stiffness[i] / (law.stiffness[i] + stiffness);
  return law.along * part.asDiagonal() * law.along.transpose();
}

}  // namespace rhexis::haptics
