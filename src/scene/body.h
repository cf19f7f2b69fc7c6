#pragma once

/// The mesh of a scene, read or generated, sound, with the sets of the scene.

#include <memory>
#include <string>
#include <vector>

#include "base/error.h"
#include "mesh/tet_mesh.h"
#include "scene/scene.h"

namespace rhexis::scene {

struct Body {
  mesh::TetMesh mesh;                   ///< the scene's sets among its own
  std::vector<bool> used;               ///< per node: some tet has it
  mesh::BoundingBox box;                ///< of the nodes that are used, m
  std::vector<mesh::TetFace> boundary;  ///< faces that one tet has, ordered
};

/// Of the mesh file that the scene names; null: it generates its mesh. Errors: the file's, placed.
[[nodiscard]] Expected<std::shared_ptr<const std::string>> read_mesh_bytes(const Scene& scene);

/// Notes say what was repaired on reading and which set of the scene stands in for one of the mesh.
[[nodiscard]] Expected<Body> make_body(const Scene& scene, std::vector<std::string>& notes);

/// The nodes of a set, at least one of them used by a tet; `place` is where the name stands.
[[nodiscard]] Expected<std::vector<NodeId>> nodes_of(const Body& body, const std::string& set, const Place& place);
/// The faces of a set or side, at least one.
[[nodiscard]] Expected<std::vector<mesh::TetFace>> faces_of(const Body& body, const FaceChoice& choice);

}  // namespace rhexis::scene
