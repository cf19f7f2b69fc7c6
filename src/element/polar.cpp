#include "element/polar.h"

#include <Eigen/Dense>

#include "base/vec.h"
#include "material/tensor.h"

namespace rhexis::element {
namespace {

inline constexpr int kWidth = 1;

// clang-format off
#include "element/simd/pack.h"
#include "element/simd/cofactor.h"
#include "element/simd/polar.h"
// clang-format on

}  // namespace

void nearest_rotation(const double (&F)[9], double (&R)[9]) {
  Pack f[9], cof[9];
  for (int i = 0; i < 9; ++i) f[i] = F[i];
  cofactor(f, cof);
  const Polar polar = polar_of(f, f[0] * cof[0] + f[1] * cof[1] + f[2] * cof[2]);
  for (int i = 0; i < 9; ++i) R[i] = polar.R[i].v[0];
}

void rotation_by_eigenvectors(const double (&F)[9], double (&R)[9]) {
  using RowMat3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  const Mat3 f = Eigen::Map<const RowMat3>(F);
  Eigen::Map<RowMat3> r(R);
  const double scale = f.cwiseAbs().maxCoeff();
  if (!f.allFinite()) {
    r.setConstant(std::numeric_limits<double>::quiet_NaN());
    return;
  }
  if (scale == 0.0) {
    r.setIdentity();
    return;
  }
  // tr(R(q)^T F) = q^T N q for the unit quaternion q = (w, x, y, z).
  const Mat3 g = f / scale;
  const double trace = g.trace();
  Eigen::Matrix4d N;
  N(0, 0) = trace;
  N.block<1, 3>(0, 1) << g(2, 1) - g(1, 2), g(0, 2) - g(2, 0), g(1, 0) - g(0, 1);
  N.block<3, 1>(1, 0) = N.block<1, 3>(0, 1).transpose();
  N.block<3, 3>(1, 1) = g + g.transpose() - trace * Mat3::Identity();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> eigen(N);
  const Eigen::Vector4d q = eigen.eigenvectors().col(3);
  r = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
}

}  // namespace rhexis::element
