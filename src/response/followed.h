#pragma once

/// What edits did to a body, in the words of the front tree.

#include <cstdint>
#include <vector>

#include "linalg/front_tree.h"
#include "mesh/torn_mesh.h"

namespace rhexis::response {

/// Adds what an edit changed that `mesh` has taken, or has given back: tets that went or came, took other nodes, or
/// have a node that moved. `kept` stays as it is. Several edits one after the other may be added, or one that was taken
/// back.
void add_applied(const mesh::TornMesh& mesh, const mesh::MeshEdit& edit, linalg::ElementChange& change);
void add_taken_back(const mesh::TornMesh& mesh, const mesh::MeshEdit& edit, linalg::ElementChange& change);

}  // namespace rhexis::response
