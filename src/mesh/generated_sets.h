#pragma once

/// The named sets of generated bodies.

#include <string>
#include <vector>

#include "mesh/tet_mesh.h"

namespace rhexis::mesh {

/// Adds `faces` as a face set, and their nodes as the node set of the same name. Both come out ascending.
void add_surface(TetMesh& mesh, std::string name, std::vector<TetFace> faces);

/// "-x", "+x", "-y", "+y", "-z", "+z" of a body that fills [0, size] and whose side nodes lie on the sides exactly.
void add_box_sides(TetMesh& mesh, const Vec3& size);

/// Appends a tet, turned where needed such that its volume is positive.
void add_oriented_tet(TetMesh& mesh, Tet tet);

}  // namespace rhexis::mesh
