#pragma once

/// The rigid motions that supports leave a body, by name.

#include <string>
#include <vector>

#include "base/vec.h"

namespace rhexis::scene {

/// A displacement component that is prescribed at a point.
struct HeldComponent {
  Vec3 point = Vec3::Zero();  ///< m
  int axis = 0;               ///< 0 x, 1 y, 2 z
};

/// A motion counts as free when no held component resists it by more than this, relative to the largest displacement
/// that the motion gives a body of that size.
inline constexpr double kFreeMotion = 1e-6;

/// "translation along y", "rotation about an axis along z through (0, 0.005, 0)", ...; empty when there is none.
/// `centre` and `size` (a length) are of the body, m.
[[nodiscard]] std::vector<std::string> free_rigid_motions(const std::vector<HeldComponent>& held, const Vec3& centre,
                                                          double size);

}  // namespace rhexis::scene
