#pragma once

/// Refinement of a mesh: the same body with edges half as long.

#include "mesh/tet_mesh.h"

namespace rhexis::model {

/// Eight tets of each: four at the corners, four around the shortest diagonal of the octahedron that is left. The nodes
/// begin with those of the coarse mesh, and tets 8 e .. 8 e + 7 fill the coarse tet e. Node sets gain the middles of
/// the edges with both ends in them, as nodes_of_set has it for P2: what is held stays the same part of the body.
/// Face sets are not carried over.
[[nodiscard]] mesh::TetMesh refine(const mesh::TetMesh& coarse);

}  // namespace rhexis::model
