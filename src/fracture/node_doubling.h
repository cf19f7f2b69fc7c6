#pragma once

#include <span>

#include "mesh/torn_mesh.h"

namespace rhexis::fracture {

/// Opens faces: every node of them is doubled as many times as the tets around it come apart when one may not pass
/// through an opened face. Appends to `copied` and `rewired` of the edit. The part with the lowest tet keeps the node;
/// at the front of a crack there is one part, and nothing is doubled. `opened`: both sides of each face, ascending.
void double_nodes(const mesh::TornMesh& body, std::span<const mesh::TetFace> opened, mesh::MeshEdit& edit);

}  // namespace rhexis::fracture
