#include "fracture/cut_edges.h"

#include <algorithm>
#include <iterator>

namespace rhexis::fracture {
namespace {

template <class T>
void sort_unique(std::vector<T>& items) {
  std::sort(items.begin(), items.end());
  items.erase(std::unique(items.begin(), items.end()), items.end());
}

}  // namespace

std::vector<TetId> tets_near(const mesh::TornMesh& body, const Surroundings& surroundings, const CutGeometry& surface,
                             const mesh::BoundingBox& within) {
  const Vec3 margin = Vec3::Constant(surface.on_plane());
  std::vector<TetId> near;
  for (const CutTriangle& triangle : surface.triangles()) {
    const Vec3 from = within.from.cwiseMax(triangle.box.from - margin);
    const Vec3 to = within.to.cwiseMin(triangle.box.to + margin);
    if ((from.array() > to.array()).any()) continue;
    const std::vector<TetId> some = surroundings.tets_meeting(body, from, to);
    near.insert(near.end(), some.begin(), some.end());
  }
  sort_unique(near);
  return near;
}

std::vector<Edge> edges_of(const mesh::TornMesh& body, std::span<const TetId> tets) {
  std::vector<Edge> edges;
  edges.reserve(6 * tets.size());
  for (const TetId tet : tets) {
    const mesh::Tet& nodes = body.mesh().tet(tet);
    for (const auto& [i, j] : mesh::kTetEdges)
      edges.push_back(std::minmax(nodes[static_cast<std::size_t>(i)], nodes[static_cast<std::size_t>(j)]));
  }
  sort_unique(edges);
  return edges;
}

std::vector<CrossedEdge> crossed_edges(const NodeMoves& moves, const CutGeometry& surface,
                                       std::span<const Edge> edges) {
  std::vector<CrossedEdge> crossed;
  for (const auto& [a, b] : edges)
    if (const auto crossing = surface.crossing(moves.position(a), moves.position(b)))
      crossed.push_back({crossing->a_above ? a : b, crossing->a_above ? b : a, crossing->triangle, crossing->at});
  return crossed;
}

std::vector<TetId> tets_with(const mesh::TornMesh& body, std::span<const CrossedEdge> edges) {
  std::vector<TetId> tets;
  for (const CrossedEdge& edge : edges) {
    const auto a = body.tets_around(edge.above);
    const auto b = body.tets_around(edge.below);
    std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(tets));
  }
  std::erase_if(tets, [&](TetId tet) { return !body.is_solved(tet); });
  sort_unique(tets);
  return tets;
}

std::vector<NodeId> ends_of(std::span<const CrossedEdge> edges) {
  std::vector<NodeId> nodes;
  for (const CrossedEdge& edge : edges) nodes.insert(nodes.end(), {edge.above, edge.below});
  sort_unique(nodes);
  return nodes;
}

}  // namespace rhexis::fracture
