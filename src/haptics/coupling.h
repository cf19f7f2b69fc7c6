#pragma once

/// What the device feels of a body that answers linearly, through a spring: the virtual hand lies between the two where
/// their forces are equal, and the body is moved by it.
///
///     device x ----/\/\/\---- hand p ----[ K ]---- rest r        k (x - p) = K (p - r) = f
///
/// K is symmetric, so the three equations part along its eigenvectors: f_i = (x - r)_i / (1 / k + 1 / K_i). Where |f|
/// would be more than the limit F, the spring gives way: k becomes the smaller 1 / c with |f| = F. That is the force of
/// a potential (a Huber spring in series with K), which clipping f would not be: over a closed loop no work is done.

#include <limits>

#include "base/vec.h"

namespace rhexis::haptics {

/// A law in the measure of the device.
struct FeltLaw {
  Vec3 stiffness = Vec3::Zero();  ///< N/m, of the body along each of `along`; not negative
  Mat3 along = Mat3::Identity();  ///< columns: orthonormal
  Vec3 rest = Vec3::Zero();       ///< m, where no force is
  Vec3 normal = Vec3::UnitZ();    ///< outward, unit
  bool pushes_only = false;       ///< no force where the body would be pulled

  /// Of the symmetric part of `stiffness`, without what is negative: no potential has the rest.
  static FeltLaw make(const Mat3& stiffness, const Vec3& rest, const Vec3& normal, bool pushes_only) noexcept;
};

struct Coupled {
  Vec3 force = Vec3::Zero();  ///< N, of the device on the hand, and so of the hand on the body
  Vec3 hand = Vec3::Zero();   ///< m
  double energy = 0.0;        ///< J, in the body beyond `rest` and in the coupling
  bool limited = false;
};

/// Of a spring of `stiffness` (N/m, may be infinite) that gives no more than `limit` (N; infinite: any), with the
/// device at `at` (m). A rigid spring (infinite stiffness and limit) has the hand at the device.
[[nodiscard]] Coupled couple(const FeltLaw& law, const Vec3& at, double stiffness,
                             double limit = std::numeric_limits<double>::infinity()) noexcept;

/// N/m by N/m: how stiff the body is felt in each direction through the spring, over the stiffness of the spring:
/// symmetric, eigenvalues in [0, 1).
[[nodiscard]] Mat3 felt_part(const FeltLaw& law, double stiffness) noexcept;

}  // namespace rhexis::haptics
