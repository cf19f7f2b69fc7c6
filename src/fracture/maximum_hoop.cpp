#include "fracture/maximum_hoop.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "fracture/criterion_view.h"

namespace rhexis::fracture {
namespace {

constexpr int kTerms = 5;
using Terms = Eigen::Matrix<double, kTerms, 1>;
using StressTerms = Eigen::Matrix<double, 3, kTerms>;
/// Fewer tets than this do not carry a fit: their mean stress decides.
constexpr int kLeastTets = 15;
/// A pivot of the normal equations below this part of the largest: the tets do not tell the terms apart.
constexpr double kLeastPivot = 1e-8;

/// Stress of the terms a_1, b_1, T, a_3, b_3 of Williams' series at an angle; rows: along the present direction, along
/// the crack's normal, shear. `root` = r^1/2 (r in any unit, the same throughout).
StressTerms williams(double angle, double root) {
  const double s1 = std::sin(0.5 * angle);
  const double c1 = std::cos(0.5 * angle);
  const double s3 = std::sin(1.5 * angle);
  const double c3 = std::cos(1.5 * angle);
  const double s5 = std::sin(2.5 * angle);
  const double c5 = std::cos(2.5 * angle);
  StressTerms out;
  out.col(0) = Vec3(3.0 * c1 + c5, 5.0 * c1 - c5, s5 - s1) * (0.25 / root);
  out.col(1) = Vec3(-7.0 * s1 - s5, s5 - s1, 3.0 * c1 + c5) * (0.25 / root);
  out.col(2) = Vec3::UnitX();
  out.col(3) = Vec3(5.0 * c1 - c3, 3.0 * c1 + c3, -s1 - s3) * (0.5 * root);
  out.col(4) = Vec3(-9.0 * s1 - s3, s1 + s3, c3 - 5.0 * c1) * (0.5 * root);
  return out;
}

/// Stress in the plane of the section: along the present direction, along the crack's normal, shear.
Vec3 in_section(const FrontPoint& point, const Mat3& stress) {
  const Vec3 normal = point.normal();
  return {point.direction.dot(stress * point.direction), normal.dot(stress * normal),
          normal.dot(stress * point.direction)};
}

double hoop_of(const Vec3& stress, double angle) {
  const double s = std::sin(angle);
  const double c = std::cos(angle);
  return s * s * stress[0] + c * c * stress[1] - 2.0 * s * c * stress[2];
}

/// The angle in [-90, 90] degrees where `hoop` is largest: by degrees, then by golden section between its neighbours.
/// Of equal ones the nearest to straight ahead.
template <class Hoop>
double angle_of_maximum(const Hoop& hoop) {
  constexpr double kDegree = std::numbers::pi / 180.0;
  double best = 0.0;
  double largest = hoop(0.0);
  for (int degree = 1; degree <= 90; ++degree) {
    for (const double angle : {degree * kDegree, -degree * kDegree}) {
      const double value = hoop(angle);
      if (value <= largest) continue;
      largest = value;
      best = angle;
    }
  }
  constexpr double kGolden = 0.6180339887498949;
  double from = std::max(best - kDegree, -90.0 * kDegree);
  double to = std::min(best + kDegree, 90.0 * kDegree);
  for (int step = 0; step < 35; ++step) {  // 2 degrees times 0.618^35: 2e-9 radians, below what a flat top can tell
    const double left = to - kGolden * (to - from);
    const double right = from + kGolden * (to - from);
    if (hoop(left) < hoop(right)) {
      from = left;
    } else {
      to = right;
    }
  }
  return 0.5 * (from + to);
}

/// What the tets of the ring say together.
struct Ring {
  int tets = 0;
  double volume = 0.0;  ///< m^3
  Vec3 stress = Vec3::Zero();
  Eigen::Matrix<double, kTerms, kTerms> normal = Eigen::Matrix<double, kTerms, kTerms>::Zero();
  Terms right = Terms::Zero();

  void add(const Vec3& of_tet, double weight, double angle, double edges) {
    const StressTerms terms = williams(angle, std::sqrt(edges));
    ++tets;
    volume += weight;
    stress += weight * of_tet;
    normal += weight * terms.transpose() * terms;
    right += weight * terms.transpose() * of_tet;
  }
};

}  // namespace

Judgement MaximumHoop::judge(const FrontSection& section, std::span<const TetStress> tets) const {
  const FrontPoint& point = section.point;
  Judgement out;
  out.direction = point.direction;
  Ring ring;
  for (const TetStress& tet : tets) {
    const auto seen = see(section, tet);
    if (!seen) continue;
    const double angle = std::atan2(seen->above, seen->ahead);
    const Vec3 stress = in_section(point, tet.stress);
    if (counts(*seen, settings_) && hoop_of(stress, angle) >= settings_.advance_threshold)
      out.length = std::max(out.length, seen->distance());
    const double edges = seen->distance() / settings_.mean_edge;
    if (edges >= kRingInner && edges <= kRingOuter) ring.add(stress, tet.volume, angle, edges);
  }
  if (ring.tets == 0) return out;

  const Eigen::LDLT<Eigen::Matrix<double, kTerms, kTerms>> factor(ring.normal);
  const auto pivots = factor.vectorD();
  const bool fits = ring.tets >= kLeastTets && pivots.minCoeff() > kLeastPivot * pivots.maxCoeff();
  Terms fit = fits ? Terms(factor.solve(ring.right)) : Terms::Zero();
  // The two terms that grow with the distance have taken what belongs to the plate; the tip's own are left.
  fit.tail<2>().setZero();
  const double root = std::sqrt(kJudgedAt);
  const Vec3 mean = ring.stress / ring.volume;
  const auto hoop = [&](double angle) { return hoop_of(fits ? Vec3(williams(angle, root) * fit) : mean, angle); };
  const double angle = angle_of_maximum(hoop);
  out.value = hoop(angle);
  out.met = out.value >= settings_.strength;
  out.direction = std::cos(angle) * point.direction + std::sin(angle) * point.normal();
  return out;
}

}  // namespace rhexis::fracture
