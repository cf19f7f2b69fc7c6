#include "fracture/incision.h"

#include "fracture/keep_nodes.h"
#include "fracture/split.h"

namespace rhexis::fracture {

Incision incise(const mesh::TornMesh& body, const Surroundings& surroundings, const CutSurface& surface,
                const IncisionSettings& settings) {
  const CutGeometry geometry(surface.triangles, kOnPlane * settings.mean_edge);
  if (geometry.triangles().empty()) return {};
  return settings.method == IncisionMethod::keep_nodes ? incise_keeping_nodes(body, surroundings, geometry, settings)
                                                       : incise_splitting(body, surroundings, geometry, settings);
}

}  // namespace rhexis::fracture
