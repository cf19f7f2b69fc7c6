#include "fracture/incision.h"

#include <algorithm>

#include "fracture/keep_nodes.h"
#include "fracture/split.h"

namespace rhexis::fracture {
namespace {

/// Tets whose box is within `reach` (m) of that of one of the triangles; ascending.
std::vector<TetId> tets_near(const mesh::TornMesh& body, const Surroundings& surroundings, const CutGeometry& surface,
                             double reach) {
  const Vec3 margin = Vec3::Constant(reach);
  std::vector<TetId> near;
  for (const CutTriangle& triangle : surface.triangles()) {
    const std::vector<TetId> some =
        surroundings.tets_meeting(body, triangle.box.from - margin, triangle.box.to + margin);
    near.insert(near.end(), some.begin(), some.end());
  }
  std::sort(near.begin(), near.end());
  near.erase(std::unique(near.begin(), near.end()), near.end());
  return near;
}

}  // namespace

Incision incise(const mesh::TornMesh& body, const Surroundings& surroundings, const CutSurface& surface,
                const IncisionSettings& settings) {
  const CutGeometry geometry(surface.triangles, kOnPlane * settings.mean_edge);
  if (settings.method == IncisionMethod::keep_nodes) {
    const std::vector<TetId> near = tets_near(body, surroundings, geometry, geometry.on_plane());
    return incise_keeping_nodes(body, geometry, settings, near);
  }
  const std::vector<TetId> near = tets_near(body, surroundings, geometry, kJoinReach * settings.mean_edge);
  return incise_splitting(body, geometry, settings, near);
}

}  // namespace rhexis::fracture
