#pragma once

/// The tractions of a scene as nodal forces.

#include "model/space.h"
#include "scene/body.h"

namespace rhexis::scene {

/// force += the tractions (N). Errors: faces that are not there, forces too large for a computer's numbers.
Expected<void> add_tractions(const Scene& scene, const Body& body, const model::DisplacementSpace& space,
                             VectorX& force);

}  // namespace rhexis::scene
