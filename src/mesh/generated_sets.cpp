#include "mesh/generated_sets.h"

#include <algorithm>

#include <Eigen/Dense>

#include "mesh/surface.h"

namespace rhexis::mesh {

void add_surface(TetMesh& mesh, std::string name, std::vector<TetFace> faces) {
  std::vector<NodeId> nodes;
  nodes.reserve(3 * faces.size());
  for (const TetFace face : faces)
    for (const NodeId node : face_nodes(mesh, face)) nodes.push_back(node);
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  std::sort(faces.begin(), faces.end());
  mesh.node_sets.push_back({name, std::move(nodes)});
  mesh.face_sets.push_back({std::move(name), std::move(faces)});
}

void add_box_sides(TetMesh& mesh, const Vec3& size) {
  const std::vector<TetFace> boundary = find_faces(mesh).boundary;
  const std::array<std::string, 3> axes{"x", "y", "z"};
  for (int axis = 0; axis < 3; ++axis)
    for (const bool upper : {false, true}) {
      const double plane = upper ? size[axis] : 0.0;
      std::vector<TetFace> side;
      for (const TetFace face : boundary) {
        const auto nodes = face_nodes(mesh, face);
        if (std::all_of(nodes.begin(), nodes.end(), [&](NodeId n) { return mesh.node(n)[axis] == plane; }))
          side.push_back(face);
      }
      add_surface(mesh, (upper ? "+" : "-") + axes[static_cast<std::size_t>(axis)], std::move(side));
    }
}

void add_oriented_tet(TetMesh& mesh, Tet tet) {
  mesh.tets.push_back(tet);
  if (signed_volume(mesh, TetId(mesh.tet_count() - 1)) < 0.0) std::swap(mesh.tets.back()[2], mesh.tets.back()[3]);
}

}  // namespace rhexis::mesh
