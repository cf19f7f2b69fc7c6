#include "model/rigid_motion.h"

#include <algorithm>

#include <Eigen/Dense>

namespace rhexis::model {
namespace {

using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;

}  // namespace

RigidMotions free_motions(const std::vector<HeldComponent>& held, const Vec3& centre, double size) {
  // The component of a motion along an axis e is t . e + w . ((X - centre) / size x e), so a held component is one row,
  // and the free motions are the null space of all.
  Mat6 gram = Mat6::Zero();
  for (const HeldComponent& component : held) {
    const Vec3 axis = Vec3::Unit(component.axis);
    Vec6 row;
    row << axis, ((component.point - centre) / size).cross(axis);
    gram += row * row.transpose();
  }
  const auto rows = static_cast<double>(std::max<std::size_t>(held.size(), 1));
  const Eigen::SelfAdjointEigenSolver<Mat6> eigen(gram / rows);
  Eigen::Index count = 0;  // eigenvalues ascend; they are mean squares
  while (count < 6 && eigen.eigenvalues()[count] <= kFreeMotion * kFreeMotion) ++count;
  return eigen.eigenvectors().leftCols(count);
}

}  // namespace rhexis::model
