#pragma once

/// One tet of small strains by itself: what tearing needs of a handful of tets at a time, where the batched kernels
/// serve whole bodies.

#include <array>

#include <Eigen/Core>

#include "base/vec.h"
#include "material/parameters.h"

namespace rhexis::element {

struct LinearTet {
  std::array<Vec3, 4> gradient;  ///< of the shape functions, 1/m
  double volume = 0.0;           ///< m^3; positive when positively oriented
};
/// `corners` X0..X3, m, of a tet that is not flat.
[[nodiscard]] LinearTet make_linear_tet(const std::array<Vec3, 4>& corners);

/// grad u of the corner displacements `u` (m).
[[nodiscard]] Mat3 displacement_gradient(const LinearTet& tet, const std::array<Vec3, 4>& u);
/// sigma = lambda tr(eps) I + 2 mu eps, eps = sym(grad u), Pa.
[[nodiscard]] Mat3 small_strain_stress(const material::Elastic& elastic, const Mat3& gradient_of_u);
/// K_e, N/m, dof = 3 corner + component.
void small_strain_stiffness(const material::Elastic& elastic, const LinearTet& tet, Eigen::Matrix<double, 12, 12>& out);

}  // namespace rhexis::element
