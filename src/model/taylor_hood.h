#pragma once

/// `taylor-hood`: quadratic displacements (P2), linear continuous mean stress (P1, one lambda per vertex), the same law
/// as `hyperelastic` on an inf-sup stable pair: the answer that the other models are measured against.

#include <memory>

#include "mesh/tet_mesh.h"
#include "model/make_model.h"
#include "model/model.h"

namespace rhexis::model {

/// Reads law and initial_lambda of the settings.
[[nodiscard]] std::unique_ptr<Model> make_taylor_hood(const mesh::TetMesh& mesh, const ModelSettings& settings);

}  // namespace rhexis::model
