#include "fracture/keep_nodes.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <unordered_map>
#include <utility>

#include "fracture/cut_edges.h"
#include "fracture/node_moves.h"

namespace rhexis::fracture {
namespace {

/// Moves that stopped short are taken up again once the others have moved: that often clears the way. Few rounds, since
/// what is still held back then is held back by its own tets.
constexpr int kRounds = 3;

/// A foot is passed on from plane to plane this often: a fold has two.
constexpr int kMostFolds = 2;

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

/// The foot on the plane (4.13). Where the crack turns, the foot may be beyond the fold, inside the other flank: from
/// there it goes on to the part of the crack that it is beside. Ahead of the front it stays on the plane.
Vec3 place_on(const CutGeometry& crack, const Projection& end, const NodeMoves& moves) {
  Vec3 foot = end.plane->projected(moves.position(end.node));
  for (int fold = 0; fold < kMostFolds; ++fold) {
    const CutTriangle& beside = crack.facing(foot);
    if (std::abs(beside.height(foot)) <= crack.on_plane()) break;
    foot = beside.projected(foot);
  }
  return foot;
}

/// Whether a node on the surface holds the two sides together, by tets other than `removed`. On a flank, or on the
/// outer surface of the body, it has tets on one side only.
bool joins_the_sides(const mesh::TornMesh& body, const CutGeometry& surface, NodeId node,
                     const std::vector<TetId>& removed) {
  bool above = false;
  bool below = false;
  for (const TetId tet : body.tets_around(node)) {
    if (!body.is_solved(tet) || std::binary_search(removed.begin(), removed.end(), tet)) continue;
    for (const NodeId corner : body.mesh().tet(tet)) {
      const double height = surface.height(body.mesh().node(corner));
      above = above || height > surface.on_plane();
      below = below || height < -surface.on_plane();
    }
    if (above && below) return true;
  }
  return false;
}

/// What holds the two sides together: edges from above to below, a node on the surface counting as above if it joins
/// them still when the other edges are gone. Behind the new surface too: an edge that was crossed ahead of the front is
/// behind it when its end has moved.
std::vector<CrossedEdge> edges_to_cut(const mesh::TornMesh& body, const CutGeometry& joined,
                                      std::vector<CrossedEdge> edges) {
  const auto on_surface = [&](const CrossedEdge& edge) {
    return joined.triangles()[edge.triangle].height(body.mesh().node(edge.above)) <= joined.on_plane();
  };
  const auto at_nodes = std::stable_partition(edges.begin(), edges.end(), std::not_fn(on_surface));
  const std::vector<TetId> removed = tets_with(body, {edges.begin(), at_nodes});
  std::unordered_map<NodeId, bool> joining;
  edges.erase(std::remove_if(at_nodes, edges.end(),
                             [&](const CrossedEdge& edge) {
                               const auto [at, is_new] = joining.try_emplace(edge.above, false);
                               if (is_new) at->second = joins_the_sides(body, joined, edge.above, removed);
                               return !at->second;
                             }),
              edges.end());
  return edges;
}

}  // namespace

Incision incise_keeping_nodes(const mesh::TornMesh& body, const Surroundings& surroundings, const CutGeometry& surface,
                              const IncisionSettings& settings) {
  CutGeometry joined = surface;
  joined.join(surface.behind(body.history(), settings.mean_edge));
  const std::vector<TetId> near = tets_near(body, surroundings, joined, surface.box(kJoinReach * settings.mean_edge));
  const std::vector<CrossedEdge> edges =
      edges_to_cut(body, joined, crossed_edges(NodeMoves(body, {}, settings), joined, edges_of(body, near)));

  Incision incision;
  incision.edges_cut = static_cast<int>(std::count_if(
      edges.begin(), edges.end(), [&](const CrossedEdge& edge) { return edge.triangle < surface.triangles().size(); }));
  if (incision.edges_cut == 0) return incision;
  incision.edit.removed = tets_with(body, edges);
  incision.edit.swept = surface.corners();
  NodeMoves moves(body, incision.edit.removed, settings);

  std::vector<Projection> waiting;
  for (const Projection& end : projections(joined, edges, moves)) {
    if (end.distance <= surface.on_plane()) continue;
    if (moves.is_movable(end.node))
      waiting.push_back(end);
    else
      ++incision.nodes_off_plane;
  }
  for (int round = 0; round < kRounds; ++round) {
    std::vector<Projection> behind;
    for (const Projection& end : waiting)
      if (!moves.move_towards(end.node, place_on(joined, end, moves))) behind.push_back(end);
    waiting = std::move(behind);
  }
  incision.nodes_off_plane += static_cast<int>(waiting.size());
  incision.edit.moved = moves.moved();
  incision.volume_lost = moves.volume_lost();
  return incision;
}

}  // namespace rhexis::fracture
