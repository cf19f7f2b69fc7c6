#include "fracture/tet_stress.h"

#include <Eigen/Eigenvalues>

namespace rhexis::fracture {

PrincipalStress principal_stress(const Mat3& stress) {
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(stress);
  PrincipalStress out;
  for (int k = 0; k < 3; ++k) {
    out.value[static_cast<std::size_t>(k)] = solver.eigenvalues()[2 - k];
    out.axes.col(k) = solver.eigenvectors().col(2 - k);
  }
  if (out.axes.determinant() < 0.0) out.axes.col(2) = -out.axes.col(2);
  return out;
}

}  // namespace rhexis::fracture
