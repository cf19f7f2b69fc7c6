#include "model/refine.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "model/space.h"

namespace rhexis::model {
namespace {

struct Diagonal {
  NodeId from, to;
  std::array<NodeId, 4> ring;
};

void add_children(const mesh::TetMesh& coarse, std::size_t t, const EdgeTable& table, mesh::TetMesh& fine) {
  const auto& [a, b, c, d] = coarse.tets[t];
  std::array<NodeId, 6> middle;  // in the order of mesh::kTetEdges: ab ac ad bc bd cd
  for (std::size_t e = 0; e < 6; ++e)
    middle[e] = NodeId(coarse.node_count() + static_cast<std::size_t>(table.of_tet[t][e]));
  const auto& [ab, ac, ad, bc, bd, cd] = middle;
  for (const mesh::Tet& corner :
       {mesh::Tet{a, ab, ac, ad}, mesh::Tet{b, ab, bc, bd}, mesh::Tet{c, ac, bc, cd}, mesh::Tet{d, ad, bd, cd}})
    fine.tets.push_back(corner);

  const std::array<Diagonal, 3> diagonals{
      {{ab, cd, {ac, bc, bd, ad}}, {ac, bd, {ab, bc, cd, ad}}, {ad, bc, {ab, ac, cd, bd}}}};
  // Rounded, so that diagonals of equal length are chosen between by their order and not by the last bit.
  const double unit = 1e-9 * (coarse.node(a) - coarse.node(b)).norm();
  const auto length = [&](const Diagonal& x) {
    return std::round((fine.node(x.from) - fine.node(x.to)).norm() / unit);
  };
  const Diagonal& shortest = *std::min_element(diagonals.begin(), diagonals.end(),
                                               [&](const auto& x, const auto& y) { return length(x) < length(y); });
  for (std::size_t r = 0; r < 4; ++r)
    fine.tets.push_back({shortest.from, shortest.to, shortest.ring[r], shortest.ring[(r + 1) % 4]});
}

}  // namespace

mesh::TetMesh refine(const mesh::TetMesh& coarse) {
  const EdgeTable table = find_edges(coarse);
  mesh::TetMesh fine;
  fine.nodes = coarse.nodes;
  for (const auto& [a, b] : table.edges) fine.nodes.push_back(0.5 * (coarse.node(a) + coarse.node(b)));
  for (std::size_t t = 0; t < coarse.tet_count(); ++t) add_children(coarse, t, table, fine);
  // Which two vertices are swapped decides between diagonals of equal length when this mesh is refined again.
  for (std::size_t t = 0; t < fine.tet_count(); ++t)
    if (mesh::signed_volume(fine, TetId(t)) < 0.0) std::swap(fine.tets[t][1], fine.tets[t][2]);

  for (const mesh::NodeSet& set : coarse.node_sets) {
    mesh::NodeSet finer = set;
    const auto has = [&](NodeId node) { return std::binary_search(set.nodes.begin(), set.nodes.end(), node); };
    for (std::size_t e = 0; e < table.edges.size(); ++e)
      if (has(table.edges[e][0]) && has(table.edges[e][1])) finer.nodes.emplace_back(coarse.node_count() + e);
    fine.node_sets.push_back(std::move(finer));
  }
  return fine;
}

}  // namespace rhexis::model
