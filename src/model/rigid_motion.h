#pragma once

/// Whether held points leave a body a rigid motion.

#include <vector>

#include <Eigen/Core>

#include "base/vec.h"

namespace rhexis::model {

/// A displacement component that is prescribed at a point.
struct HeldComponent {
  Vec3 point = Vec3::Zero();  ///< m
  int axis = 0;               ///< 0 x, 1 y, 2 z
};

/// A motion counts as free when no held component resists it by more than this, relative to the largest displacement
/// that the motion gives a body of that size.
inline constexpr double kFreeMotion = 1e-6;

/// One rigid motion a column, (t, w): the displacement t + w x (X - centre) / size.
using RigidMotions = Eigen::Matrix<double, 6, Eigen::Dynamic>;

/// An orthonormal basis of the motions that nothing resists; no column when all are held. `centre` and `size` (a
/// length) are of the body, m.
[[nodiscard]] RigidMotions free_motions(const std::vector<HeldComponent>& held, const Vec3& centre, double size);

}  // namespace rhexis::model
