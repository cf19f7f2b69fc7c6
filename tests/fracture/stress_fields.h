#pragma once

/// Tets around a front without a mesh: places and volumes at random, stresses by a formula.

#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

#include <Eigen/Geometry>

#include "fracture/criterion.h"

namespace rhexis::fracture::test {

inline constexpr double kDegree = std::numbers::pi / 180.0;

/// In [0, 1), the same on every machine.
inline double uniform(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

/// Stress at distance r and angle theta from the direction +x, normal +y.
using Field = std::function<Mat3(double r, double theta)>;

inline Mat3 in_plane(double xx, double yy, double xy) {
  Mat3 stress = Mat3::Zero();
  stress(0, 0) = xx;
  stress(1, 1) = yy;
  stress(0, 1) = stress(1, 0) = xy;
  return stress;
}

/// Irwin's field of a sharp crack, plane stress, with the stress T along the crack.
inline Field tip_field(double K_I, double K_II, double T = 0.0) {
  return [=](double r, double theta) {
    const double s = std::sin(theta / 2.0);
    const double c = std::cos(theta / 2.0);
    const double s3 = std::sin(1.5 * theta);
    const double c3 = std::cos(1.5 * theta);
    const double a = K_I / std::sqrt(2.0 * std::numbers::pi * r);
    const double b = K_II / std::sqrt(2.0 * std::numbers::pi * r);
    return in_plane(a * c * (1.0 - s * s3) - b * s * (2.0 + c * c3) + T, a * c * (1.0 + s * s3) + b * s * c * c3,
                    a * s * c * c3 + b * c * (1.0 - s * s3));
  };
}

inline Field uniform_field(const Mat3& stress) {
  return [stress](double, double) { return stress; };
}

/// `count` tets up to 3.4 mean edges (m) around a front at the origin along +z that runs to +x.
inline std::vector<TetStress> tets_around(const Field& field, double mean_edge, int count = 200,
                                          std::uint64_t seed = 1) {
  std::mt19937_64 random(seed);
  std::vector<TetStress> tets;
  for (int i = 0; i < count; ++i) {
    const double r = mean_edge * (0.4 + 3.0 * std::sqrt(uniform(random)));
    const double theta = std::numbers::pi * (2.0 * uniform(random) - 1.0);
    TetStress& tet = tets.emplace_back();
    tet.tet = TetId(i);
    tet.centroid = Vec3(r * std::cos(theta), r * std::sin(theta), mean_edge * (uniform(random) - 0.5));
    tet.volume = std::pow(mean_edge, 3) * (0.05 + 0.1 * uniform(random));
    tet.stress = field(r, theta);
  }
  return tets;
}

/// Degrees from the present direction, towards the upper flank.
inline double turn_of(const Judgement& judgement, const FrontPoint& point) {
  return std::atan2(judgement.direction.dot(point.normal()), judgement.direction.dot(point.direction)) / kDegree;
}

}  // namespace rhexis::fracture::test
