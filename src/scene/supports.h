#pragma once

/// The supports of a scene as prescribed unknowns.

#include "model/loading.h"
#include "model/space.h"
#include "scene/body.h"

namespace rhexis::scene {

/// Ascending by dof; nodes that no tet has are held. Errors: a set that is not there, a component fixed twice with
/// different values, a rigid motion that is left free.
[[nodiscard]] Expected<std::vector<model::PrescribedDof>> make_supports(const Scene& scene, const Body& body,
                                                                        const model::DisplacementSpace& space);

}  // namespace rhexis::scene
