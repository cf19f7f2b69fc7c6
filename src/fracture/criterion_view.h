#pragma once

/// A tet as a point of a front sees it: polar coordinates in the plane normal to the front's tangent.

#include <cmath>
#include <optional>

#include "fracture/criterion.h"

namespace rhexis::fracture {

/// A centroid this far behind the front, in mean edges, still counts as beside it: rounding of coordinates.
inline constexpr double kBeside = 1e-9;

struct SeenTet {
  double ahead = 0.0;  ///< m, along the present direction
  double above = 0.0;  ///< m, along the crack's normal
  /// m, from the front across its tangent
  [[nodiscard]] double distance() const { return std::hypot(ahead, above); }
};

/// Empty for a tet at the hand or out of the section.
[[nodiscard]] inline std::optional<SeenTet> see(const FrontSection& section, const TetStress& tet) {
  if (tet.at_hand) return std::nullopt;
  const Vec3 way = tet.centroid - section.point.position;
  if (std::abs(way.dot(section.point.tangent)) > section.half_width) return std::nullopt;
  SeenTet seen;
  seen.ahead = way.dot(section.point.direction);
  seen.above = way.dot(section.point.normal());
  return seen;
}

/// False for a tet behind the front with `ahead_only`.
[[nodiscard]] inline bool counts(const SeenTet& seen, const CriterionSettings& settings) {
  return !settings.ahead_only || seen.ahead >= -kBeside * settings.mean_edge;
}

}  // namespace rhexis::fracture
