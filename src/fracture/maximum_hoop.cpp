#include "fracture/maximum_hoop.h"

#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "fracture/criterion_view.h"

namespace rhexis::fracture {
namespace {

constexpr int kTerms = 5;
using Terms = Eigen::Matrix<double, kTerms, 1>;
/// A fit takes this many tets for each of its terms; with fewer the mean stress decides.
constexpr int kTetsPerTerm = 3;

/// `ratio` = (r0 / r)^1/2.
Terms basis(double angle, double ratio) {
  const double c = std::cos(0.5 * angle);
  Terms out;
  out << ratio * c * c * c, ratio * std::sin(angle) * c, 1.0, std::cos(2.0 * angle), std::sin(2.0 * angle);
  return out;
}

/// Stress in the plane of the section: along the present direction, along the crack's normal, and the shear.
struct PlaneStress {
  double ahead = 0.0;
  double above = 0.0;
  double shear = 0.0;

  PlaneStress() = default;
  PlaneStress(const FrontPoint& point, const Mat3& stress) {
    const Vec3 normal = point.normal();
    ahead = point.direction.dot(stress * point.direction);
    above = normal.dot(stress * normal);
    shear = normal.dot(stress * point.direction);
  }
  [[nodiscard]] double hoop(double angle) const {
    const double s = std::sin(angle);
    const double c = std::cos(angle);
    return s * s * ahead + c * c * above - 2.0 * s * c * shear;
  }
  void add(const PlaneStress& other, double weight) {
    ahead += weight * other.ahead;
    above += weight * other.above;
    shear += weight * other.shear;
  }
};

/// The angle in [-90, 90] degrees where `hoop` is largest: by degrees, then by golden section in the best two. Of equal
/// ones the nearest to straight ahead.
template <class Hoop>
double angle_of_maximum(const Hoop& hoop) {
  constexpr double kDegree = std::numbers::pi / 180.0;
  double best = 0.0;
  double largest = hoop(0.0);
  for (int degree = 1; degree <= 90; ++degree) {
    for (const double angle : {degree * kDegree, -degree * kDegree}) {
      const double value = hoop(angle);
      if (value > largest) {
        largest = value;
        best = angle;
      }
    }
  }
  constexpr double kGolden = 0.6180339887498949;
  double from = std::max(best - kDegree, -90.0 * kDegree);
  double to = std::min(best + kDegree, 90.0 * kDegree);
  for (int step = 0; step < 40; ++step) {  // 2 degrees times 0.618^40: 2e-10 radians, as flat as a maximum can be told
    const double left = to - kGolden * (to - from);
    const double right = from + kGolden * (to - from);
    if (hoop(left) < hoop(right))
      from = left;
    else
      to = right;
  }
  return 0.5 * (from + to);
}

}  // namespace

Judgement MaximumHoop::judge(const FrontSection& section, std::span<const TetStress> tets) const {
  const FrontPoint& point = section.point;
  Judgement out;
  out.direction = point.direction;
  const auto in_ring = [&](const SeenTet& seen) {
    return seen.distance >= kRingInner * settings_.mean_edge && seen.distance <= kRingOuter * settings_.mean_edge;
  };

  int count = 0;
  double volume = 0.0;
  double radius = 0.0;
  PlaneStress mean;
  for (const TetStress& tet : tets) {
    const auto seen = see(section, tet, settings_);
    if (!seen) continue;
    const PlaneStress stress(point, tet.stress);
    if (stress.hoop(std::atan2(seen->above, seen->ahead)) >= settings_.advance_threshold)
      out.length = std::max(out.length, seen->distance);
    if (!in_ring(*seen)) continue;
    ++count;
    volume += tet.volume;
    radius += tet.volume * seen->distance;
    mean.add(stress, tet.volume);
  }
  if (count == 0) return out;
  radius /= volume;

  double angle = 0.0;
  if (count < kTerms * kTetsPerTerm) {
    const auto hoop = [&](double at) { return mean.hoop(at) / volume; };
    angle = angle_of_maximum(hoop);
    out.value = hoop(angle);
  } else {
    Eigen::Matrix<double, Eigen::Dynamic, kTerms> rows(count, kTerms);
    VectorX values(count);
    int row = 0;
    for (const TetStress& tet : tets) {
      const auto seen = see(section, tet, settings_);
      if (!seen || !in_ring(*seen)) continue;
      const double at = std::atan2(seen->above, seen->ahead);
      const double weight = std::sqrt(tet.volume / volume);
      rows.row(row) = weight * basis(at, std::sqrt(radius / seen->distance)).transpose();
      values[row++] = weight * PlaneStress(point, tet.stress).hoop(at);
    }
    const Terms fit = rows.colPivHouseholderQr().solve(values);
    const auto hoop = [&](double at) { return fit.dot(basis(at, 1.0)); };
    angle = angle_of_maximum(hoop);
    out.value = hoop(angle);
  }
  out.met = out.value >= settings_.strength;
  out.direction = std::cos(angle) * point.direction + std::sin(angle) * point.normal();
  return out;
}

}  // namespace rhexis::fracture
