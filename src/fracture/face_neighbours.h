#pragma once

#include "mesh/torn_mesh.h"

namespace rhexis::fracture {

/// The alive tet that has all of `nodes` and is not `tet`; not valid where there is none.
[[nodiscard]] TetId other_tet_with(const mesh::TornMesh& body, TetId tet, const std::array<NodeId, 3>& nodes);

/// The alive tet on the other side of a face; not valid at the surface. Both share three nodes.
[[nodiscard]] TetId tet_across(const mesh::TornMesh& body, mesh::TetFace face);

}  // namespace rhexis::fracture
