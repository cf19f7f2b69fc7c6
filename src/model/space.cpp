#include "model/space.h"

#include <algorithm>

#include "base/check.h"

namespace rhexis::model {
namespace {

/// Both ends in one number, so that sorting numbers sorts edges by (smaller, larger) end.
std::uint64_t edge_key(NodeId a, NodeId b) {
  const auto [low, high] = std::minmax(a, b);
  return (static_cast<std::uint64_t>(low.value()) << 32) | static_cast<std::uint64_t>(high.value());
}

/// Place in mesh::kTetEdges of the edge between two vertices of a tet.
int local_edge(int i, int j) {
  static constexpr int kEdgeOf[4][4] = {{-1, 0, 1, 2}, {0, -1, 3, 4}, {1, 3, -1, 5}, {2, 4, 5, -1}};
  return kEdgeOf[i][j];
}

}  // namespace

EdgeTable find_edges(const mesh::TetMesh& mesh) {
  std::vector<std::uint64_t> keys;
  keys.reserve(6 * mesh.tet_count());
  const auto key_of = [](const mesh::Tet& tet, const std::array<int, 2>& edge) {
    return edge_key(tet[static_cast<std::size_t>(edge[0])], tet[static_cast<std::size_t>(edge[1])]);
  };
  for (const mesh::Tet& tet : mesh.tets) {
    for (const auto& edge : mesh::kTetEdges) keys.push_back(key_of(tet, edge));
  }
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());

  EdgeTable table;
  table.edges.reserve(keys.size());
  for (const std::uint64_t key : keys) {
    table.edges.push_back({NodeId(static_cast<std::int32_t>(key >> 32)), NodeId(static_cast<std::int32_t>(key))});
  }
  table.of_tet.resize(mesh.tet_count());
  for (std::size_t t = 0; t < mesh.tet_count(); ++t) {
    for (std::size_t e = 0; e < 6; ++e) {
      const auto found = std::lower_bound(keys.begin(), keys.end(), key_of(mesh.tets[t], mesh::kTetEdges[e]));
      table.of_tet[t][e] = static_cast<std::int32_t>(found - keys.begin());
    }
  }
  return table;
}

DisplacementSpace make_p1_space(const mesh::TetMesh& mesh) {
  DisplacementSpace space;
  space.order = 1;
  space.nodes = mesh.nodes;
  space.connectivity.reserve(4 * mesh.tet_count());
  for (const mesh::Tet& tet : mesh.tets) {
    for (const NodeId node : tet) space.connectivity.push_back(node.value());
  }
  return space;
}

DisplacementSpace make_p2_space(const mesh::TetMesh& mesh) {
  EdgeTable table = find_edges(mesh);
  const auto vertices = static_cast<std::int32_t>(mesh.node_count());
  DisplacementSpace space;
  space.order = 2;
  space.nodes.reserve(mesh.node_count() + table.edges.size());
  space.nodes = mesh.nodes;
  for (const auto& [a, b] : table.edges) space.nodes.push_back(0.5 * (mesh.node(a) + mesh.node(b)));
  space.connectivity.reserve(10 * mesh.tet_count());
  for (std::size_t t = 0; t < mesh.tet_count(); ++t) {
    for (const NodeId node : mesh.tets[t]) space.connectivity.push_back(node.value());
    for (const std::int32_t edge : table.of_tet[t]) space.connectivity.push_back(vertices + edge);
  }
  space.edges = std::move(table.edges);
  return space;
}

std::vector<std::int32_t> nodes_of_set(const DisplacementSpace& space, const std::vector<NodeId>& set) {
  std::vector<bool> in_set(space.vertex_count(), false);
  for (const NodeId node : set) {
    RHEXIS_CHECK(node.valid() && node.index() < in_set.size(), "node {} of {}", node.value(), in_set.size());
    in_set[node.index()] = true;
  }
  std::vector<std::int32_t> nodes;
  for (std::size_t i = 0; i < in_set.size(); ++i) {
    if (in_set[i]) nodes.push_back(static_cast<std::int32_t>(i));
  }
  for (std::size_t i = 0; i < space.edges.size(); ++i) {
    const auto& [a, b] = space.edges[i];
    if (in_set[a.index()] && in_set[b.index()]) nodes.push_back(static_cast<std::int32_t>(in_set.size() + i));
  }
  return nodes;
}

std::array<std::int32_t, 6> nodes_of_face(const DisplacementSpace& space, mesh::TetFace face) {
  const auto& corner = mesh::kTetFaces[static_cast<std::size_t>(face.vertex)];
  const std::int32_t* tet = &space.connectivity[face.tet.index() * static_cast<std::size_t>(space.nodes_per_tet())];
  std::array<std::int32_t, 6> nodes{tet[corner[0]], tet[corner[1]], tet[corner[2]], -1, -1, -1};
  if (space.order == 2) {
    for (std::size_t i = 0; i < 3; ++i) nodes[3 + i] = tet[4 + local_edge(corner[i], corner[(i + 1) % 3])];
  }
  return nodes;
}

}  // namespace rhexis::model
