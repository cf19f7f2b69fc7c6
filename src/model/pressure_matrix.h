#pragma once

/// The constant matrix of the mean stress: C = diag(V) / kappa + K_S, equation (6) of the paper.

#include "linalg/saddle_matrix.h"
#include "mesh/tet_mesh.h"
#include "model/make_model.h"

namespace rhexis::model {

/// K_S couples the two tets of each interior face by beta (h_e + h_j) area / kappa, h the longest edge of a tet: the
/// sum of (5) runs over tets and meets an interior face from both sides. Boundary faces carry no term. With beta = 0
/// the pattern is the diagonal alone. Tets left out have a diagonal entry, and no face. m^3/Pa.
[[nodiscard]] linalg::SymmetricCsr make_pressure_matrix(const mesh::TetMesh& mesh, double kappa, double beta,
                                                        LeftOut left_out = {});

}  // namespace rhexis::model
