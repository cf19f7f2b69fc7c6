#include "mesh/nearest.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

namespace rhexis::mesh {
namespace {

/// Part of the way from `a` to `b`.
double nearest_part(const Vec3& a, const Vec3& b, const Vec3& at) {
  const Vec3 way = b - a;
  const double size = way.squaredNorm();
  return size > 0.0 ? std::clamp(way.dot(at - a) / size, 0.0, 1.0) : 0.0;
}

}  // namespace

Vec3 nearest_on_segment(const Vec3& a, const Vec3& b, const Vec3& at) { return a + nearest_part(a, b, at) * (b - a); }

TrianglePoint nearest_in_triangle(const std::array<Vec3, 3>& corner, const Vec3& at) {
  const Vec3 normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
  const double size = normal.squaredNorm();
  // Of the foot of the perpendicular: how far on the inner side of the side opposite to each corner.
  Vec3 inside = Vec3::Zero();
  for (std::size_t k = 0; k < 3 && size > 0.0; ++k) {
    const Vec3& a = corner[(k + 1) % 3];
    inside[static_cast<Eigen::Index>(k)] = (corner[(k + 2) % 3] - a).cross(at - a).dot(normal);
  }
  if (inside.minCoeff() > 0.0) {
    const Vec3 unit = normal / std::sqrt(size);
    return {at - unit.dot(at - corner[0]) * unit, inside / inside.sum()};
  }
  TrianglePoint best;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 3; ++k) {  // the nearest point is on a side that it is beyond
    if (inside[static_cast<Eigen::Index>(k)] > 0.0) continue;
    const std::size_t a = (k + 1) % 3;
    const std::size_t b = (k + 2) % 3;
    const double part = nearest_part(corner[a], corner[b], at);
    const Vec3 position = corner[a] + part * (corner[b] - corner[a]);
    const double distance = (position - at).squaredNorm();
    if (!(distance < least)) continue;
    least = distance;
    best.position = position;
    best.weight.setZero();
    best.weight[static_cast<Eigen::Index>(a)] = 1.0 - part;
    best.weight[static_cast<Eigen::Index>(b)] = part;
  }
  return best;
}

}  // namespace rhexis::mesh
