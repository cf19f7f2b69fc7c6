#pragma once

/// What the criteria judge by: the stress of the tets of the local object.

#include <array>

#include "base/ids.h"
#include "base/vec.h"

namespace rhexis::fracture {

struct TetStress {
  TetId tet;
  Vec3 centroid = Vec3::Zero();  ///< reference, m
  double volume = 0.0;           ///< reference, m^3
  Mat3 stress = Mat3::Zero();    ///< Cauchy, Pa, positive in tension
  bool at_hand = false;          ///< has a held node: does not count
};

/// s1 >= s2 >= s3 (Pa) and their unit directions in the columns of `axes`, right-handed.
struct PrincipalStress {
  std::array<double, 3> value{};
  Mat3 axes = Mat3::Identity();
};
[[nodiscard]] PrincipalStress principal_stress(const Mat3& stress);

}  // namespace rhexis::fracture
