#include "mesh/tet_mesh.h"

#include <algorithm>

#include <Eigen/Dense>

namespace rhexis::mesh {

const NodeSet* TetMesh::find_node_set(std::string_view name) const {
  const auto found =
      std::find_if(node_sets.begin(), node_sets.end(), [&](const NodeSet& set) { return set.name == name; });
  return found == node_sets.end() ? nullptr : &*found;
}

const FaceSet* TetMesh::find_face_set(std::string_view name) const {
  const auto found =
      std::find_if(face_sets.begin(), face_sets.end(), [&](const FaceSet& set) { return set.name == name; });
  return found == face_sets.end() ? nullptr : &*found;
}

std::array<Vec3, 4> corners(const TetMesh& mesh, TetId tet) {
  const Tet& t = mesh.tet(tet);
  return {mesh.node(t[0]), mesh.node(t[1]), mesh.node(t[2]), mesh.node(t[3])};
}

double signed_volume(const TetMesh& mesh, TetId tet) {
  const auto [a, b, c, d] = corners(mesh, tet);
  return (b - a).cross(c - a).dot(d - a) / 6.0;
}

double total_volume(const TetMesh& mesh) {
  double volume = 0.0;
  for (std::size_t t = 0; t < mesh.tet_count(); ++t) volume += signed_volume(mesh, TetId(t));
  return volume;
}

double longest_edge(const TetMesh& mesh, TetId tet) {
  const std::array<Vec3, 4> x = corners(mesh, tet);
  double longest = 0.0;
  for (const auto& [i, j] : kTetEdges)
    longest = std::max(longest, (x[static_cast<std::size_t>(i)] - x[static_cast<std::size_t>(j)]).norm());
  return longest;
}

std::array<NodeId, 3> face_nodes(const TetMesh& mesh, TetFace face) {
  const Tet& t = mesh.tet(face.tet);
  const auto& f = kTetFaces[static_cast<std::size_t>(face.vertex)];
  return {t[static_cast<std::size_t>(f[0])], t[static_cast<std::size_t>(f[1])], t[static_cast<std::size_t>(f[2])]};
}

BoundingBox bounding_box(const TetMesh& mesh) {
  if (mesh.nodes.empty()) return {};
  BoundingBox box{mesh.nodes.front(), mesh.nodes.front()};
  for (const Vec3& x : mesh.nodes) {
    box.from = box.from.cwiseMin(x);
    box.to = box.to.cwiseMax(x);
  }
  return box;
}

}  // namespace rhexis::mesh
