#pragma once

/// A body of any of the live models while it tears: what its model leaves out, and its loading, of one topology. Tets
/// and nodes keep the numbers of the torn mesh; what is out of the solve is left out of the model, and held where it
/// is.

#include <cstdint>
#include <vector>

#include "mesh/torn_mesh.h"
#include "model/loading.h"
#include "model/make_model.h"
#include "response/elastic_elements.h"

namespace rhexis::response {

/// A pressure that follows the surface. It acts on faces of the intact body for as long as their tets are in the solve;
/// what a crack opens has none.
struct SurfacePressure {
  std::vector<mesh::TetFace> faces;
  double value = 0.0;  ///< Pa, against the outward normal
};

struct LiveBody {
  ElasticBody body;  ///< supports and dead loads; `elastic` is not read
  model::ModelSettings model;
  std::vector<SurfacePressure> pressures;
};

/// Per tet: nonzero where it is out of the solve.
[[nodiscard]] std::vector<std::uint8_t> tets_left_out(const mesh::TornMesh& mesh);
/// Nodes out of the solve are held at `u` (m, 3 per node).
[[nodiscard]] model::Loading make_torn_loading(const mesh::TornMesh& mesh, const LiveBody& body,
                                               const model::DisplacementSpace& space, const VectorX& u);

}  // namespace rhexis::response
