#include "element/linear_tet.h"

#include <Eigen/LU>

namespace rhexis::element {

LinearTet make_linear_tet(const std::array<Vec3, 4>& corners) {
  Mat3 edges;
  for (int k = 0; k < 3; ++k) edges.col(k) = corners[static_cast<std::size_t>(k) + 1] - corners[0];
  const Mat3 inverse = edges.inverse();
  LinearTet out;
  out.volume = edges.determinant() / 6.0;
  for (int k = 0; k < 3; ++k) out.gradient[static_cast<std::size_t>(k) + 1] = inverse.row(k).transpose();
  out.gradient[0] = -(out.gradient[1] + out.gradient[2] + out.gradient[3]);
  return out;
}

Mat3 displacement_gradient(const LinearTet& tet, const std::array<Vec3, 4>& u) {
  Mat3 out = Mat3::Zero();
  for (std::size_t a = 0; a < 4; ++a) out += u[a] * tet.gradient[a].transpose();
  return out;
}

Mat3 small_strain_stress(const material::Elastic& elastic, const Mat3& gradient_of_u) {
  const Mat3 strain = 0.5 * (gradient_of_u + gradient_of_u.transpose());
  return elastic.lame_lambda() * strain.trace() * Mat3::Identity() + 2.0 * elastic.lame_mu() * strain;
}

void small_strain_stiffness(const material::Elastic& elastic, const LinearTet& tet,
                            Eigen::Matrix<double, 12, 12>& out) {
  const double lambda = elastic.lame_lambda() * tet.volume;
  const double mu = elastic.lame_mu() * tet.volume;
  for (int a = 0; a < 4; ++a) {
    const Vec3& ga = tet.gradient[static_cast<std::size_t>(a)];
    for (int b = 0; b < 4; ++b) {
      const Vec3& gb = tet.gradient[static_cast<std::size_t>(b)];
      // V (lambda ga gb^T + mu gb ga^T + mu (ga . gb) I)
      out.block<3, 3>(3 * a, 3 * b) =
          lambda * ga * gb.transpose() + mu * gb * ga.transpose() + mu * ga.dot(gb) * Mat3::Identity();
    }
  }
}

}  // namespace rhexis::element
