#pragma once

#include <Eigen/Geometry>

#include "base/vec.h"

namespace rhexis::element {

/// det(F) F^-T, of a singular F too; its first row times that of F is det F.
[[nodiscard]] inline Mat3 cofactor(const Mat3& F) {
  Mat3 out;
  for (int i = 0; i < 3; ++i) out.row(i) = F.row((i + 1) % 3).cross(F.row((i + 2) % 3));
  return out;
}

}  // namespace rhexis::element
