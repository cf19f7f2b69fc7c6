#pragma once

/// Does the body tear at a point of a front, in which direction, how far (section 2.3 of the method). A criterion sees
/// the stress of the tets around that point and nothing else; it has no state, so one serves all fronts and threads.

#include <array>
#include <limits>
#include <memory>
#include <span>
#include <string_view>

#include "base/error.h"
#include "fracture/crack.h"
#include "fracture/tet_stress.h"

namespace rhexis::fracture {

/// The names that a scene may say.
inline constexpr std::array<std::string_view, 4> kCriterionNames{"maximum-principal", "maximum-shear", "von-mises",
                                                                 "maximum-hoop"};

struct CriterionSettings {
  double strength = 0.0;           ///< s_f, Pa: the point tears where the value reaches it
  double advance_threshold = 0.0;  ///< Pa, <= strength: how far it tears, of the same quantity
  bool ahead_only = true;          ///< leave out tets whose centroid is more than 90 degrees off the present direction
  double mean_edge = 0.0;          ///< m, of the intact mesh
};

/// A point of a front with the part of the front that it speaks for.
struct FrontSection {
  FrontPoint point;
  double half_width = std::numeric_limits<double>::infinity();  ///< m, along the tangent; a plate's line: everything
};

struct Judgement {
  bool met = false;                ///< value >= strength
  double value = 0.0;              ///< Pa, what is compared with the strength; 0 without a tet to judge by
  Vec3 direction = Vec3::UnitX();  ///< unit, normal to the tangent, at most 90 degrees from the present direction
  double length = 0.0;  ///< m: largest distance from the front to the centroid of a tet above the advance threshold
  TetId tet;            ///< the one that decided; not valid where it was a ring of them, or none
};

class Criterion {
 public:
  virtual ~Criterion() = default;
  /// Distances and angles are taken in the plane normal to the tangent. Tets at the hand do not count.
  [[nodiscard]] virtual Judgement judge(const FrontSection& section, std::span<const TetStress> tets) const = 0;
};

/// An unknown name is an error that says the nearest known one; so is a threshold above the strength, or a strength or
/// mean edge that is not positive.
[[nodiscard]] Expected<std::unique_ptr<Criterion>> make_criterion(std::string_view name,
                                                                  const CriterionSettings& settings);

/// With a toughness (N/m, energy per area of crack) in place of the strength: tears where the energy release (N/m) of
/// the point reaches it, while the criterion finds tension there (value > 0; a closed crack releases nothing); the
/// direction is the criterion's, the length one mean edge. Judged again after each advance, the crack goes on while the
/// release stays at or above the toughness. A release that is not finite meets none.
[[nodiscard]] Judgement by_toughness(const Judgement& judgement, double energy_release, double toughness,
                                     double mean_edge);

}  // namespace rhexis::fracture
