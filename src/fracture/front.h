#pragma once

/// The front of a general body as a regular polyline that ends on the body's surface.

#include <vector>

#include "fracture/crack.h"
#include "fracture/front_surroundings.h"

namespace rhexis::fracture {

/// A stretch of a front shorter than this many mean edges is none: a corner that it touches.
inline constexpr double kShortestFront = 0.25;

/// Changes the first and last step (m, per point) so that the moved front ends on the intact surface: straight on along
/// the moved front where the surface is within two mean edges, else at the nearest point of it. Ends that come to lie
/// outside stay where they are.
void end_on_surface(const Crack& crack, std::vector<Vec3>& step, const Surroundings& surroundings);

/// What of a polyline lies in the intact body, as cracks: one per separate stretch, its points a mean edge apart (the
/// same between all of a stretch), tangents along it, directions between those of the points and normal to the tangent.
/// `front`: positions and directions are read, at least two points.
[[nodiscard]] std::vector<Crack> settle(const std::vector<FrontPoint>& front, const Surroundings& surroundings);

}  // namespace rhexis::fracture
