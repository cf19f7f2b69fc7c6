#include <Eigen/Cholesky>

#include "base/check.h"
#include "response/contact.h"

namespace rhexis::response {

Vec3 ContactLaw::force(const Vec3& hand) const {
  const Vec3 f = stiffness * (hand - rest);
  return mode == ContactMode::push && f.dot(normal) >= 0.0 ? Vec3(Vec3::Zero()) : f;
}

Eigen::Matrix<double, 9, 1> ContactLaw::nodal_forces(const Vec3& hand) const {
  const Vec3 d = hand - rest;
  const bool apart = mode == ContactMode::push && (stiffness * d).dot(normal) >= 0.0;
  return apart ? Eigen::Matrix<double, 9, 1>(Eigen::Matrix<double, 9, 1>::Zero())
               : Eigen::Matrix<double, 9, 1>(spread * d);
}

ContactLaw make_contact_law(const SurfacePoint& point, ContactRule rule, ContactMode mode,
                            const Eigen::MatrixXd& compliance, const VectorX& rest) {
  const Eigen::Index n = 3 * point.count;
  RHEXIS_CHECK(compliance.rows() == n && compliance.cols() == n && rest.size() == n, "{} nodes, compliance {} x {}",
               point.count, compliance.rows(), compliance.cols());
  ContactLaw law;
  law.mode = mode;
  law.normal = point.normal;
  // N^T of u(q) = N u: the weights on the diagonal of each node's block.
  Eigen::MatrixXd weights = Eigen::MatrixXd::Zero(n, 3);
  for (int a = 0; a < point.count; ++a) weights.block<3, 3>(3 * a, 0) = point.weight[a] * Mat3::Identity();
  law.rest = weights.transpose() * rest;

  if (mode == ContactMode::push) {
    // One constraint along the normal, of whichever rule: f = n (n . d) / (n^T C n).
    const Eigen::MatrixXd along = weights * point.normal;
    if (rule == ContactRule::consistent) {
      const double softness = (along.transpose() * compliance * along)(0, 0);
      law.spread.topRows(n) = along * point.normal.transpose() / softness;
    } else {
      for (int a = 0; a < point.count; ++a) {
        const double softness = point.normal.dot(compliance.block<3, 3>(3 * a, 3 * a) * point.normal);
        law.spread.block<3, 3>(3 * a, 0) = point.weight[a] / softness * point.normal * point.normal.transpose();
      }
    }
  } else if (rule == ContactRule::consistent) {
    const Mat3 at_point = weights.transpose() * compliance * weights;  // N L N^T
    law.spread.topRows(n) = weights * at_point.llt().solve(Mat3::Identity());
  } else {
    for (int a = 0; a < point.count; ++a) {
      const Mat3 alone = compliance.block<3, 3>(3 * a, 3 * a);
      law.spread.block<3, 3>(3 * a, 0) = point.weight[a] * alone.llt().solve(Mat3::Identity());  // (3.32), (3.33)
    }
  }
  for (int a = 0; a < point.count; ++a) law.stiffness += law.spread.block<3, 3>(3 * a, 0);
  return law;
}

}  // namespace rhexis::response
