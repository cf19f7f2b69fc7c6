#pragma once

/// Choice and reach of the pressure stabilisation; derivation and evidence in docs/stabilisation.md.

#include "material/parameters.h"
#include "mesh/tet_mesh.h"

namespace rhexis::model {

/// `beta = "auto"`: (3 kappa - 4 mu) / (16 mu), at least 0; no unit. It makes the least damped spurious pressure
/// exactly as stiff as a physical pressure wave: (1 + 4 beta) / kappa = 3 / (4 mu). The mesh enters through h_e in the
/// jump term.
[[nodiscard]] double auto_beta(const material::MooneyRivlin& law);

/// Length over which beta smooths a resolved pressure wave, m: the jump term against mass and elastic compliance,
/// sqrt((beta / kappa) D / (1 / kappa + 3 / (4 mu))) with D = h^2 / 2, h the volume-weighted mean of h_e.
[[nodiscard]] double smoothing_length(const mesh::TetMesh& mesh, const material::MooneyRivlin& law, double beta);

}  // namespace rhexis::model
