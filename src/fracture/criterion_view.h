#pragma once

/// A tet as a point of a front sees it: polar coordinates in the plane normal to the front's tangent.

#include <optional>

#include "fracture/criterion.h"

namespace rhexis::fracture {

/// A centroid this far behind the front, in mean edges, still counts as beside it: rounding of coordinates.
inline constexpr double kBeside = 1e-9;

struct SeenTet {
  double distance = 0.0;  ///< m, from the front across its tangent
  double ahead = 0.0;     ///< m, along the present direction
  double above = 0.0;     ///< m, along the crack's normal
  double along = 0.0;     ///< m, along the tangent
};

/// Empty for a tet that does not count: at the hand, out of the section, or behind with `ahead_only`.
[[nodiscard]] inline std::optional<SeenTet> see(const FrontSection& section, const TetStress& tet,
                                                const CriterionSettings& settings) {
  if (tet.at_hand) return std::nullopt;
  const Vec3 way = tet.centroid - section.point.position;
  const double along = way.dot(section.point.tangent);
  if (std::abs(along) > section.half_width) return std::nullopt;
  SeenTet seen;
  seen.along = along;
  seen.ahead = way.dot(section.point.direction);
  seen.above = way.dot(section.point.normal());
  seen.distance = std::hypot(seen.ahead, seen.above);
  if (settings.ahead_only && seen.ahead < -kBeside * settings.mean_edge) return std::nullopt;
  return seen;
}

}  // namespace rhexis::fracture
