#include "scene/rigid_motion.h"

#include <cmath>

#include <fmt/format.h>
#include <Eigen/Dense>

namespace rhexis::scene {
namespace {

std::string text_of_direction(const Vec3& d) {
  for (int axis = 0; axis < 3; ++axis)
    if (std::abs(d[axis]) > 1.0 - 1e-6) return std::string(1, "xyz"[axis]);
  return fmt::format("({:.3f}, {:.3f}, {:.3f})", d[0], d[1], d[2]);
}

std::string text_of_point(const Vec3& x, double size) {
  const auto clean = [&](double value) { return std::abs(value) < 1e-9 * size ? 0.0 : value; };
  return fmt::format("({:.4g}, {:.4g}, {:.4g})", clean(x[0]), clean(x[1]), clean(x[2]));
}

/// An orthonormal basis of the span of the rotations, along the coordinate axes where the span holds them.
std::vector<Vec3> rotation_directions(const model::RigidMotions& free) {
  Eigen::JacobiSVD<Eigen::MatrixXd> svd(free.bottomRows<3>(), Eigen::ComputeThinU);
  svd.setThreshold(1e-4);  // pure translations have a rotation of rounding size, the others one of order 1
  Mat3 projector = svd.matrixU().leftCols(svd.rank()) * svd.matrixU().leftCols(svd.rank()).transpose();
  std::vector<Vec3> directions;
  const auto take = [&](const Vec3& direction) {
    directions.push_back(direction);
    projector -= direction * direction.transpose();
  };
  for (int axis = 0; axis < 3; ++axis)
    if ((projector.col(axis) - Vec3::Unit(axis)).norm() < 1e-4) take(Vec3::Unit(axis));
  while (static_cast<Eigen::Index>(directions.size()) < svd.rank()) {
    const Eigen::SelfAdjointEigenSolver<Mat3> eigen(projector);
    const Vec3 direction = eigen.eigenvectors().col(2);
    take(direction.sum() < 0.0 ? Vec3(-direction) : direction);
  }
  return directions;
}

}  // namespace

std::vector<std::string> free_rigid_motions(const std::vector<model::HeldComponent>& held, const Vec3& centre,
                                            double size) {
  const model::RigidMotions free = model::free_motions(held, centre, size);
  std::vector<std::string> names;
  if (free.cols() == 0) return names;

  // Supports hold components, so a translation is free exactly along the axes that none of them holds.
  std::array<bool, 3> translates{true, true, true};
  for (const model::HeldComponent& component : held) translates[static_cast<std::size_t>(component.axis)] = false;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (translates[axis]) names.push_back(fmt::format("translation along {}", "xyz"[axis]));

  const Eigen::MatrixXd rotations = free.bottomRows<3>();
  const auto to_null_space = rotations.completeOrthogonalDecomposition();
  for (const Vec3& direction :
       names.size() == static_cast<std::size_t>(free.cols()) ? std::vector<Vec3>{} : rotation_directions(free)) {
    Vec3 shift = (free * to_null_space.solve(direction)).head<3>();
    for (int axis = 0; axis < 3; ++axis)
      if (translates[static_cast<std::size_t>(axis)]) shift[axis] = 0.0;
    // shift + direction x (X - centre) / size has no part across the direction on the axis through:
    const Vec3 through = centre + size * direction.cross(shift);
    const bool slides = std::abs(shift.dot(direction)) > 1e-4;
    names.push_back(fmt::format("{} about an axis along {} through {} m", slides ? "screw motion" : "rotation",
                                text_of_direction(direction), text_of_point(through, size)));
  }
  return names;
}

}  // namespace rhexis::scene
