#include "fracture/criterion_one_tet.h"

#include <algorithm>
#include <cmath>

#include "fracture/criterion_view.h"

namespace rhexis::fracture {
namespace {

/// Principal stresses closer than this, relative to the largest magnitude, are the same: they have no axis of their
/// own.
constexpr double kSameStress = 1e-9;
/// A plane whose normal lies this close to the tangent does not meet the plane of the section in a line.
constexpr double kAlongTangent = 1e-6;

/// The principal direction k; where it is one of several alike, the one nearest to `toward`.
Vec3 axis_near(const PrincipalStress& principal, int k, const Vec3& toward) {
  const double scale = std::max(std::abs(principal.value[0]), std::abs(principal.value[2]));
  Vec3 sum = Vec3::Zero();
  for (int i = 0; i < 3; ++i) {
    const double apart =
        std::abs(principal.value[static_cast<std::size_t>(i)] - principal.value[static_cast<std::size_t>(k)]);
    if (apart <= kSameStress * scale) sum += principal.axes.col(i).dot(toward) * principal.axes.col(i);
  }
  const double norm = sum.norm();
  return norm > kAlongTangent ? Vec3(sum / norm) : Vec3(principal.axes.col(k));
}

/// Where a plane of normal `normal` meets the plane of the section, pointing forward; the present direction when they
/// do not meet in a line.
Vec3 direction_in(const FrontPoint& point, const Vec3& normal) {
  const Vec3 across = point.tangent.cross(normal);
  const double size = across.norm();
  if (size < kAlongTangent) return point.direction;
  const double forward = across.dot(point.direction);
  const bool upright = std::abs(forward) <= kSameStress * size;  // 90 degrees: towards the upper flank
  const double side = upright ? across.dot(point.normal()) : forward;
  return across * ((side < 0.0 ? -1.0 : 1.0) / size);
}

/// Mean stress and the root of the second invariant of what is left, in which the principal stresses are
/// p + 2 sqrt(J2 / 3) cos(theta + {0, -120, 120} degrees), 0 <= theta <= 60 degrees (Lode).
struct Invariants {
  explicit Invariants(const Mat3& stress)
      : p(stress.trace() / 3.0), root_j2(std::sqrt(0.5) * (stress - p * Mat3::Identity()).norm()) {}
  double p;
  double root_j2;
};

/// A rule has a value and a direction by the principal stresses and the stretch, which maps the normals of planes back
/// to the reference, and a bound of the value that needs none.
struct MaximumPrincipal {
  static double bound(const Invariants& s) { return s.p + 2.0 / std::sqrt(3.0) * s.root_j2; }
  static double value(const PrincipalStress& s) { return s.value[0]; }
  static Vec3 direction(const PrincipalStress& s, const Mat3& stretch, const FrontPoint& point) {
    return direction_in(point, stretch * axis_near(s, 0, point.normal()));
  }
};

struct MaximumShear {
  static double bound(const Invariants& s) { return 2.0 * s.root_j2; }
  static double value(const PrincipalStress& s) { return s.value[0] - s.value[2]; }
  /// Of the two planes at 45 degrees between s1 and s3, the one nearer the present direction.
  static Vec3 direction(const PrincipalStress& s, const Mat3& stretch, const FrontPoint& point) {
    const Vec3 first = axis_near(s, 0, point.normal());
    const Vec3 third = axis_near(s, 2, point.direction);
    const Vec3 one = direction_in(point, stretch * (first + third));
    const Vec3 other = direction_in(point, stretch * (first - third));
    const double nearer = other.dot(point.direction) - one.dot(point.direction);
    if (std::abs(nearer) > kSameStress) return nearer > 0.0 ? other : one;
    return other.dot(point.normal()) > one.dot(point.normal()) ? other : one;  // alike: towards the upper flank
  }
};

struct VonMises {
  static double bound(const Invariants& s) { return std::sqrt(3.0) * s.root_j2; }
  static double value(const PrincipalStress& s) {
    const double a = s.value[0] - s.value[1];
    const double b = s.value[1] - s.value[2];
    const double c = s.value[2] - s.value[0];
    return std::sqrt(0.5 * (a * a + b * b + c * c));
  }
  /// It gives none: the plane of s1 (2.28).
  static Vec3 direction(const PrincipalStress& s, const Mat3& stretch, const FrontPoint& point) {
    return MaximumPrincipal::direction(s, stretch, point);
  }
};

template <class Rule>
class OneTetCriterion final : public Criterion {
 public:
  explicit OneTetCriterion(const CriterionSettings& settings) : settings_(settings) {}

  Judgement judge(const FrontSection& section, std::span<const TetStress> tets) const override {
    Judgement out;
    out.direction = section.point.direction;
    PrincipalStress decisive;
    Mat3 stretch = Mat3::Identity();
    for (const TetStress& tet : tets) {
      const auto seen = see(section, tet);
      if (!seen || !counts(*seen, settings_)) continue;
      // Most tets are far below what decides anything: their principal stresses are not worked out.
      const Invariants invariants(tet.stress);
      const double rounding = kSameStress * (std::abs(invariants.p) + invariants.root_j2);
      const double most = Rule::bound(invariants) + rounding;
      if (out.tet.valid() && most < settings_.advance_threshold && most < out.value) continue;
      const PrincipalStress principal = principal_stress(tet.stress);
      const double value = Rule::value(principal);
      if (value >= settings_.advance_threshold) out.length = std::max(out.length, seen->distance());
      if (!out.tet.valid() || value > out.value) {
        out.tet = tet.tet;
        out.value = value;
        decisive = principal;
        stretch = tet.stretch;
      }
    }
    if (!out.tet.valid()) return out;
    out.met = out.value >= settings_.strength;
    out.direction = Rule::direction(decisive, stretch, section.point);
    return out;
  }

 private:
  CriterionSettings settings_;
};

}  // namespace

std::unique_ptr<Criterion> make_one_tet_criterion(std::string_view name, const CriterionSettings& settings) {
  if (name == "maximum-principal") return std::make_unique<OneTetCriterion<MaximumPrincipal>>(settings);
  if (name == "maximum-shear") return std::make_unique<OneTetCriterion<MaximumShear>>(settings);
  if (name == "von-mises") return std::make_unique<OneTetCriterion<VonMises>>(settings);
  return nullptr;
}

}  // namespace rhexis::fracture
