#pragma once

/// The model that a scene asks for, on its mesh.

#include <string>
#include <vector>

#include "mesh/tet_mesh.h"
#include "model/make_model.h"
#include "scene/scene.h"

namespace rhexis::scene {

/// `beta = "auto"` is a number then. Adds what is worth saying of it, one line each.
[[nodiscard]] model::ModelSettings choose_model(const Scene& scene, const mesh::TetMesh& mesh,
                                                std::vector<std::string>& notes, std::vector<std::string>& warnings);

}  // namespace rhexis::scene
