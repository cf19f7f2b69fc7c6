#pragma once

/// Where a body hangs together by a node alone.

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "mesh/torn_mesh.h"

namespace rhexis::test {

/// Whether two tets share a face at `node`.
inline bool share_face_at(const mesh::TornMesh& body, TetId a, TetId b, NodeId node) {
  int shared = 0;
  for (const NodeId corner : body.mesh().tet(a)) {
    const mesh::Tet& other = body.mesh().tet(b);
    if (corner != node && std::find(other.begin(), other.end(), corner) != other.end()) ++shared;
  }
  return shared >= 2;
}

/// Parts into which the tets in the solve around a node fall when they hold by faces only.
inline int parts_at(const mesh::TornMesh& body, NodeId node) {
  std::vector<TetId> left;
  for (const TetId tet : body.tets_around(node))
    if (body.is_solved(tet)) left.push_back(tet);
  int parts = 0;
  while (!left.empty()) {
    ++parts;
    std::vector<TetId> open{left.back()};
    left.pop_back();
    while (!open.empty()) {
      const TetId tet = open.back();
      open.pop_back();
      for (std::size_t i = left.size(); i-- > 0;) {
        if (!share_face_at(body, tet, left[i], node)) continue;
        open.push_back(left[i]);
        left.erase(left.begin() + static_cast<std::ptrdiff_t>(i));
      }
    }
  }
  return parts;
}

/// Nodes in the solve with more than one such part.
inline std::vector<NodeId> hinges_of(const mesh::TornMesh& body) {
  std::vector<NodeId> hinges;
  for (std::size_t node = 0; node < body.mesh().node_count(); ++node)
    if (parts_at(body, NodeId(node)) > 1) hinges.emplace_back(node);
  return hinges;
}

}  // namespace rhexis::test
