#pragma once

/// The small fixed-size types of the whole project.

#include <Eigen/Core>

namespace rhexis {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using VectorX = Eigen::VectorXd;

}  // namespace rhexis
