#include "fracture/tet_stress.h"

#include <Eigen/Eigenvalues>

#include "element/polar.h"

namespace rhexis::fracture {

void set_turned_back(TetStress& tet, const Mat3& F, const Mat3& cauchy) {
  double f[9];
  double r[9];
  for (int i = 0; i < 9; ++i) f[i] = F(i / 3, i % 3);
  element::nearest_rotation(f, r);
  const Mat3 R = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(r);
  tet.stress = R.transpose() * cauchy * R;
  tet.stretch = R.transpose() * F;
}

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
