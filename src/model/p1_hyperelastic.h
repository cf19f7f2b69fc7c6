#pragma once

/// `hyperelastic`: nearly incompressible, perturbed Lagrangian, P1/P0 with pressure stabilisation (PSH); equations (1)
/// to (6) of the paper. Any isochoric law of src/material fits: the model knows its kernels alone.

#include <memory>

#include "model/make_model.h"
#include "model/model.h"

namespace rhexis::element {
struct TetKernels;
}

namespace rhexis::model {

/// Reads law (c2 = 0 is neo-Hookean), beta and initial_lambda of the settings. `left_out` as of make_model.
[[nodiscard]] std::unique_ptr<Model> make_hyperelastic(const mesh::TetMesh& mesh, const ModelSettings& settings,
                                                       const element::TetKernels& kernels, LeftOut left_out = {});

}  // namespace rhexis::model
