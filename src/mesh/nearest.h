#pragma once

/// The point of a segment or a triangle that is nearest to another point.

#include <array>

#include "base/vec.h"

namespace rhexis::mesh {

/// Of the closed segment from `a` to `b`; `a` when it has no length.
[[nodiscard]] Vec3 nearest_on_segment(const Vec3& a, const Vec3& b, const Vec3& at);

struct TrianglePoint {
  Vec3 position = Vec3::Zero();
  Vec3 weight = Vec3::Zero();  ///< area coordinates, sum 1; those of the corners that the vertex or side which the
                               ///< point is on does not have are zero to the bit
};

/// Of the closed triangle; of its sides when it has no area.
[[nodiscard]] TrianglePoint nearest_in_triangle(const std::array<Vec3, 3>& corner, const Vec3& at);

}  // namespace rhexis::mesh
