#include "response/followed.h"

#include <algorithm>

namespace rhexis::response {

/// Nodes that went with the edit need no mention: the tree sees that there are fewer.
void add_taken_back(const mesh::TornMesh& mesh, const mesh::MeshEdit& edit, linalg::ElementChange& change) {
  std::vector<std::int32_t>& touched = change.touched;
  for (const TetId tet : edit.removed) touched.push_back(tet.value());
  for (const TetId tet : edit.frozen) touched.push_back(tet.value());
  for (const mesh::RewiredTet& rewired : edit.rewired) touched.push_back(rewired.tet.value());
  for (const mesh::MovedNode& moved : edit.moved) {
    for (const TetId tet : mesh.tets_around(moved.node)) touched.push_back(tet.value());
  }
  std::sort(touched.begin(), touched.end());
  touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
}

void add_applied(const mesh::TornMesh& mesh, const mesh::MeshEdit& edit, linalg::ElementChange& change) {
  for (const NodeId parent : edit.copied) change.copied.push_back(parent.value());
  add_taken_back(mesh, edit, change);
}

}  // namespace rhexis::response
