#pragma once

/// `mass-spring`: springs on the edges, the baseline of the paper's Table 1.

#include <memory>

#include "mesh/tet_mesh.h"
#include "model/make_model.h"
#include "model/model.h"

namespace rhexis::model {

/// Reads elastic.young of the settings; Poisson's ratio is 1/4 whatever is asked.
[[nodiscard]] std::unique_ptr<Model> make_mass_spring(const mesh::TetMesh& mesh, const ModelSettings& settings);

}  // namespace rhexis::model
