#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mesh/tet_mesh.h"
#include "scene/scene.h"
#include "solver/inertia.h"

namespace rhexis::scene {

/// The scene's [dynamics]; empty without, and for a model that has no mass, which a warning says. Warns too where step
/// or damping leave nothing of a swing. Errors: no density.
[[nodiscard]] Expected<std::optional<solver::Dynamics>> choose_dynamics(const Scene& scene, const mesh::TetMesh& mesh,
                                                                        std::vector<std::string>& warnings);

}  // namespace rhexis::scene
