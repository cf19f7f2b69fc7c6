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
  /// Cauchy, Pa, positive in tension, in axes of the reference: what large strain has turned is turned back.
  Mat3 stress = Mat3::Zero();
  /// U of F = R U: the plane of normal n that the stress names was that of U n in the reference.
  Mat3 stretch = Mat3::Identity();
  bool at_hand = false;  ///< has a held node: does not count
};

/// Sets stress and stretch: R^T sigma R and U = R^T F of a tet with deformation gradient F and Cauchy stress `cauchy`
/// (Pa). So a normal n of the deformed body maps back to F^T n = U (R^T n).
void set_turned_back(TetStress& tet, const Mat3& F, const Mat3& cauchy);

/// s1 >= s2 >= s3 (Pa) and their unit directions in the columns of `axes`, right-handed.
struct PrincipalStress {
  std::array<double, 3> value{};
  Mat3 axes = Mat3::Identity();
};
[[nodiscard]] PrincipalStress principal_stress(const Mat3& stress);

}  // namespace rhexis::fracture
