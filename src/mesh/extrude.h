#pragma once

/// A plane section swept along a line, layer by layer: each triangle becomes a prism, each prism three tets.

#include <functional>
#include <optional>

#include "mesh/plane_section.h"
#include "mesh/tet_mesh.h"

namespace rhexis::mesh {

/// points * (layers + 1) nodes.
struct ExtrusionPlan {
  int points = 0;
  int layers = 0;
};

/// The best shaped tets with this many nodes, met within 2%; none when every division is too coarse for the section,
/// or its prisms would be more than kMaxPrismAspect times as high as wide, or as wide as high.
inline constexpr double kMaxPrismAspect = 10.0;
[[nodiscard]] std::optional<ExtrusionPlan> plan_extrusion(const PlaneSection& section, double height, int nodes);

/// Node k * points + i is point i of the section at layer k, put at place(point, k), k = 0..layers; `place` keeps the
/// orientation of (x, y, k). Diagonals of the prisms' sides follow an order of the nodes that is drawn anew
/// in each layer, so no direction is preferred.
[[nodiscard]] TetMesh extrude(const PlaneMesh& section, int layers,
                              const std::function<Vec3(const Point2& point, int layer)>& place);

}  // namespace rhexis::mesh
