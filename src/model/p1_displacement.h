#pragma once

/// The displacement models on linear tets: `linear`, `corotated`, `geometrically-nonlinear`. They differ in the
/// response of the kernels alone.

#include <memory>

#include "model/make_model.h"
#include "model/model.h"

namespace rhexis::element {
struct TetKernels;
}

namespace rhexis::model {

/// Reads elastic and, for corotated, corotated_tangent of the settings. `left_out` as of make_model.
[[nodiscard]] std::unique_ptr<Model> make_linear(const mesh::TetMesh& mesh, const ModelSettings& settings,
                                                 const element::TetKernels& kernels, LeftOut left_out = {});
[[nodiscard]] std::unique_ptr<Model> make_corotated(const mesh::TetMesh& mesh, const ModelSettings& settings,
                                                    const element::TetKernels& kernels, LeftOut left_out = {});
[[nodiscard]] std::unique_ptr<Model> make_geometrically_nonlinear(const mesh::TetMesh& mesh,
                                                                  const ModelSettings& settings,
                                                                  const element::TetKernels& kernels,
                                                                  LeftOut left_out = {});

}  // namespace rhexis::model
