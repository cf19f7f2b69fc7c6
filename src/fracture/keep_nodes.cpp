#include "fracture/keep_nodes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "fracture/cut_edges.h"
#include "fracture/node_moves.h"

namespace rhexis::fracture {
namespace {

/// Moves that stopped short are taken up again once the others have moved: that often clears the way. Few rounds, since
/// what is still held back then is held back by its own tets.
constexpr int kRounds = 3;

/// A node on its way to the plane.
struct Projection {
  NodeId node;
  const CutTriangle* plane = nullptr;
  double distance = 0.0;  ///< m, at the start
};

/// The plane of each end: of the triangles that its edges cross, the nearest.
std::vector<Projection> projections(const CutGeometry& surface, std::span<const CrossedEdge> edges,
                                    const NodeMoves& moves) {
  std::vector<Projection> all;
  for (const NodeId node : ends_of(edges))
    if (moves.remains(node)) all.push_back({node, nullptr, std::numeric_limits<double>::infinity()});
  const auto offer = [&](NodeId node, const CutTriangle& plane) {
    const auto at =
        std::lower_bound(all.begin(), all.end(), node, [](const Projection& p, NodeId n) { return p.node < n; });
    if (at == all.end() || at->node != node || at->plane == &plane) return;
    const Vec3& x = moves.position(node);
    const double distance = (plane.nearest(x) - x).norm();
    if (distance < at->distance) *at = {node, &plane, distance};
  };
  for (const CrossedEdge& edge : edges) {
    offer(edge.above, surface.triangles()[edge.triangle]);
    offer(edge.below, surface.triangles()[edge.triangle]);
  }
  for (Projection& p : all) p.distance = std::abs(p.plane->height(moves.position(p.node)));
  // Where all four corners of a tet are called to the plane one has to stay behind: the one with the longest way.
  std::stable_sort(all.begin(), all.end(),
                   [](const Projection& a, const Projection& b) { return a.distance < b.distance; });
  return all;
}

}  // namespace

Incision incise_keeping_nodes(const mesh::TornMesh& body, const Surroundings& surroundings, const CutGeometry& surface,
                              const IncisionSettings& settings) {
  const std::vector<TetId> near = tets_near(body, surroundings, surface, surface.box(surface.on_plane()));
  const std::vector<CrossedEdge> edges = crossed_edges(NodeMoves(body, {}, settings), surface, edges_of(body, near));

  Incision incision;
  incision.edges_cut = static_cast<int>(edges.size());
  incision.edit.removed = tets_with(body, edges);
  NodeMoves moves(body, incision.edit.removed, settings);

  std::vector<Projection> waiting;
  for (const Projection& end : projections(surface, edges, moves)) {
    if (end.distance <= surface.on_plane()) continue;
    if (moves.is_movable(end.node))
      waiting.push_back(end);
    else
      ++incision.nodes_off_plane;
  }
  for (int round = 0; round < kRounds; ++round) {
    std::vector<Projection> behind;
    for (const Projection& end : waiting)
      if (!moves.move_towards(end.node, end.plane->projected(moves.position(end.node)))) behind.push_back(end);
    waiting = std::move(behind);
  }
  incision.nodes_off_plane += static_cast<int>(waiting.size());
  incision.edit.moved = moves.moved();
  if (!edges.empty()) incision.edit.swept = surface.corners();
  incision.volume_lost = moves.volume_lost();
  return incision;
}

}  // namespace rhexis::fracture
