#include "fracture/cut_edges.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace rhexis::fracture {
namespace {

template <class T>
void sort_unique(std::vector<T>& items) {
  std::sort(items.begin(), items.end());
  items.erase(std::unique(items.begin(), items.end()), items.end());
}

}  // namespace

std::vector<CrossedEdge> crossed_edges(const mesh::TornMesh& body, const NodeMoves& moves, const CutGeometry& surface,
                                       std::span<const TetId> near) {
  std::vector<std::pair<NodeId, NodeId>> edges;
  for (const TetId tet : near) {
    if (!body.is_solved(tet)) continue;
    const mesh::Tet& nodes = body.mesh().tet(tet);
    for (const auto& [i, j] : mesh::kTetEdges)
      edges.push_back(std::minmax(nodes[static_cast<std::size_t>(i)], nodes[static_cast<std::size_t>(j)]));
  }
  sort_unique(edges);

  std::vector<CrossedEdge> crossed;
  for (const auto& [a, b] : edges) {
    const auto crossing = surface.crossing(moves.position(a), moves.position(b));
    if (!crossing) continue;
    crossed.push_back({crossing->a_above ? a : b, crossing->a_above ? b : a, crossing->triangle, crossing->at});
  }
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
