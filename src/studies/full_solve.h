#pragma once

/// What an advance costs without any of the methods of this project: the stiffness of the whole torn body assembled,
/// and inverted or factored, from nothing.

#include <optional>

#include "mesh/torn_mesh.h"
#include "response/elastic_elements.h"

namespace rhexis::studies {

struct FullSolveSeconds {
  double assembly = 0.0;
  double analysis = 0.0;  ///< order of elimination and elimination tree; none for a dense inverse
  double factor = 0.0;    ///< or inverse
  [[nodiscard]] double total() const { return assembly + analysis + factor; }
};

/// The sparse Cholesky factor of the free stiffness (linalg::CholeskyFactor, CHOLMOD). Empty: singular, the body has a
/// free motion.
[[nodiscard]] std::optional<FullSolveSeconds> time_sparse_factor(const mesh::TornMesh& body,
                                                                 const response::ElasticBody& elastic);

/// The conventional way of the thesis: K^-1 of the free dofs, dense, by Cholesky (LAPACK, one thread). 8 n^2 bytes for
/// n of them. Empty: singular, the body has a free motion.
[[nodiscard]] std::optional<FullSolveSeconds> time_dense_inverse(const mesh::TornMesh& body,
                                                                 const response::ElasticBody& elastic);

}  // namespace rhexis::studies
