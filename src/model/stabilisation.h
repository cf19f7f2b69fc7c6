#pragma once

/// Choice and reach of the pressure stabilisation; derivation in docs/stabilisation.md.

#include "material/parameters.h"
#include "mesh/tet_mesh.h"

namespace rhexis::model {

/// `beta = "auto"`: from kappa, c1, c2 and the mesh, no unit.
[[nodiscard]] double auto_beta(const mesh::TetMesh& mesh, const material::MooneyRivlin& law);

/// Length over which beta smooths lambda, m: sqrt(beta) times the volume-weighted mean of h_e.
[[nodiscard]] double smoothing_length(const mesh::TetMesh& mesh, double beta);

}  // namespace rhexis::model
