#pragma once

/// What a body that tears looks like to ParaView: section "Tearing" of docs/results.md.

#include <functional>
#include <span>
#include <vector>

#include "base/vec.h"
#include "mesh/field.h"
#include "mesh/torn_mesh.h"
#include "response/elastic_elements.h"

namespace rhexis::result {

struct TornState {
  const response::ElasticBody* body = nullptr;
  const VectorX* u = nullptr;    ///< m, 3 per node
  std::span<const TetId> local;  ///< tets of the local objects
  /// Cauchy stress of a tet in the solve, Pa, of a body of large strain; empty: by small strains.
  std::function<Mat3(TetId)> stress = {};
};

/// PointData displacement, reaction, node_alive, original_node; CellData those of fields_of_tets (0 for tets out of
/// the solve, J 1), alive, frozen, local and original_tet.
[[nodiscard]] std::vector<mesh::Field> make_torn_fields(const mesh::TornMesh& body, const TornState& state);

}  // namespace rhexis::result
