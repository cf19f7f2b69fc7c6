#include "fracture/incision.h"

#include <algorithm>

#include "fracture/keep_nodes.h"

namespace rhexis::fracture {
namespace {

/// Candidates for what the surface crosses: tets whose box meets that of one of its triangles; ascending.
std::vector<TetId> tets_near(const mesh::TornMesh& body, const Surroundings& surroundings, const CutGeometry& surface) {
  const Vec3 margin = Vec3::Constant(surface.on_plane());
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
  return incise_keeping_nodes(body, geometry, settings, tets_near(body, surroundings, geometry));
}

}  // namespace rhexis::fracture
