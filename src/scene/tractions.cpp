#include "scene/tractions.h"

#include "model/loading.h"

namespace rhexis::scene {

Expected<void> add_tractions(const Scene& scene, const Body& body, const model::DisplacementSpace& space,
                             VectorX& force) {
  for (const TractionSettings& traction : scene.tractions) {
    const Expected<std::vector<mesh::TetFace>> faces = faces_of(body, traction.faces);
    if (!faces) return fail(faces.error());
    model::add_traction(body.mesh, space, *faces, traction.force, force);
  }
  if (!force.allFinite())
    return fail("the loads are too large for a computer's numbers", "a smaller density, gravity or traction",
                scene.file);
  return {};
}

}  // namespace rhexis::scene
