#include "fracture/split.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "fracture/cut_edges.h"
#include "fracture/face_neighbours.h"
#include "fracture/node_doubling.h"
#include "fracture/node_moves.h"

namespace rhexis::fracture {
namespace {

/// Snapping one node may clear the way for another, or bring an edge across a fold of the surface: it is looked at
/// anew this many times.
constexpr int kRounds = 3;

/// A move that changes the volume around a node by less than this times the cube of the mean edge keeps it: rounding of
/// some tens of tets.
constexpr double kSameVolume = 1e-12;

/// Brings the mesh on to the surface, as far as its tets allow.
class Snapping {
 public:
  Snapping(const mesh::TornMesh& body, const CutGeometry& surface, const IncisionSettings& settings,
           std::span<const TetId> near)
      : body_(body), surface_(surface), near_(near), moves_(body, {}, settings) {
    least_gain_ = kSameVolume * settings.mean_edge * settings.mean_edge * settings.mean_edge;
    for (const TetId tet : near)
      for (const NodeId node : body.mesh().tet(tet))
        if (surface.is_on(body.mesh().node(node))) on_.insert(node);
  }

  [[nodiscard]] const NodeMoves& moves() const { return moves_; }
  /// Nodes on the surface.
  [[nodiscard]] const std::set<NodeId>& on() const { return on_; }

  /// Edges that the surface crosses elsewhere than at a node on it.
  [[nodiscard]] std::vector<CrossedEdge> crossed() const {
    std::vector<CrossedEdge> edges = crossed_edges(body_, moves_, surface_, near_);
    std::erase_if(edges, [&](const CrossedEdge& edge) { return is_at_node(edge); });
    return edges;
  }

  /// The nearer end of each crossed edge goes to the surface, or the other one, or none. Whether anything moved.
  bool snap() {
    std::vector<CrossedEdge> edges = crossed();
    std::map<NodeId, std::vector<std::size_t>> edges_of;
    for (std::size_t e = 0; e < edges.size(); ++e)
      for (const NodeId end : {edges[e].above, edges[e].below}) edges_of[end].push_back(e);
    std::vector<std::size_t> order(edges.size());
    for (std::size_t e = 0; e < order.size(); ++e) order[e] = e;
    const auto distance = [&](std::size_t e) { return std::min(height(edges[e], true), height(edges[e], false)); };
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return distance(a) < distance(b); });
    bool moved = false;
    for (const std::size_t e : order) {
      const CrossedEdge& edge = edges[e];
      if (!is_still_crossed(edge)) continue;
      const bool upper_first = height(edge, true) <= height(edge, false);
      for (const NodeId end : {upper_first ? edge.above : edge.below, upper_first ? edge.below : edge.above}) {
        if (on_.count(end) != 0 || !bring(end, edges, edges_of[end])) continue;
        on_.insert(end);
        moved = true;
        break;
      }
    }
    return moved;
  }

 private:
  [[nodiscard]] double height(const CrossedEdge& edge, bool upper) const {
    return std::abs(surface_.triangles()[edge.triangle].height(moves_.position(upper ? edge.above : edge.below)));
  }

  [[nodiscard]] bool is_at_node(const CrossedEdge& edge) const {
    return height(edge, true) <= surface_.on_plane() || height(edge, false) <= surface_.on_plane();
  }

  /// One end may have come to the surface for the sake of another edge.
  [[nodiscard]] bool is_still_crossed(const CrossedEdge& edge) const {
    const auto now = surface_.crossing(moves_.position(edge.above), moves_.position(edge.below));
    return now && !is_at_node({edge.above, edge.below, now->triangle, now->at});
  }

  /// To the foot on the surface if that leaves the volume as it is (inside the body, or along a flat side), else to
  /// where one of its edges passes through the surface; of several places the one that changes the volume least.
  bool bring(NodeId node, const std::vector<CrossedEdge>& edges, const std::vector<std::size_t>& own) {
    if (!moves_.is_movable(node)) return false;
    const Vec3& at = moves_.position(node);
    std::vector<std::pair<double, Vec3>> places;
    const Vec3 foot = surface_.facing(at).projected(at);
    if (surface_.is_on(foot)) places.emplace_back(0.0, foot);
    for (const std::size_t e : own) places.emplace_back(0.0, edges[e].at);
    for (auto& [gain, place] : places) {
      gain = std::abs(moves_.volume_gain(node, place));
      if (gain < least_gain_) gain = 0.0;
    }
    std::stable_sort(places.begin(), places.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    return std::any_of(places.begin(), places.end(),
                       [&](const auto& place) { return moves_.move(node, place.second); });
  }

  const mesh::TornMesh& body_;
  const CutGeometry& surface_;
  std::span<const TetId> near_;
  NodeMoves moves_;
  double least_gain_ = 0.0;
  std::set<NodeId> on_;
};

/// Faces between tets above and below, of nodes on the surface and ends of edges that are still crossed: where those
/// are the faces go round them. Both sides of each, ascending.
std::vector<mesh::TetFace> faces_along(const mesh::TornMesh& body, const CutGeometry& surface, const NodeMoves& moves,
                                       const std::set<NodeId>& nodes) {
  std::map<TetId, bool> above;  // as far as asked
  const auto is_above = [&](TetId tet) {
    const auto [at, is_new] = above.try_emplace(tet, false);
    if (is_new) {
      Vec3 centroid = Vec3::Zero();
      for (const NodeId node : body.mesh().tet(tet)) centroid += 0.25 * moves.position(node);
      at->second = surface.height(centroid) >= 0.0;
    }
    return at->second;
  };
  std::vector<mesh::TetFace> faces;
  for (const NodeId node : nodes)
    for (const TetId tet : body.tets_around(node))
      for (std::int8_t k = 0; k < 4; ++k) {
        const mesh::TetFace face{tet, k};
        const std::array<NodeId, 3> n = mesh::face_nodes(body.mesh(), face);
        if (!std::all_of(n.begin(), n.end(), [&](NodeId one) { return nodes.count(one) != 0; })) continue;
        const TetId other = tet_across(body, face);
        if (other.valid() && body.is_solved(tet) && is_above(tet) != is_above(other)) faces.push_back(face);
      }
  std::sort(faces.begin(), faces.end());
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  return faces;
}

}  // namespace

Incision incise_splitting(const mesh::TornMesh& body, const CutGeometry& surface, const IncisionSettings& settings,
                          std::span<const TetId> near) {
  const CutGeometry behind = surface.behind(body.history(), kJoinReach * settings.mean_edge);
  CutGeometry joined = surface;
  joined.join(behind);
  Snapping snapping(body, joined, settings, near);

  Incision incision;
  std::vector<CrossedEdge> edges = crossed_edges(body, snapping.moves(), surface, near);
  // The crack has been at those: the line between the old surface and the new one is on both.
  std::erase_if(edges, [&](const CrossedEdge& edge) { return behind.is_on(body.mesh().node(edge.above)); });
  incision.edges_cut = static_cast<int>(edges.size());
  if (edges.empty()) return incision;
  incision.edit.swept = surface.corners();

  for (int round = 0; round < kRounds && snapping.snap(); ++round) {
  }
  const std::vector<NodeId> off = ends_of(snapping.crossed());
  std::set<NodeId> nodes = snapping.on();
  nodes.insert(off.begin(), off.end());
  double_nodes(body, faces_along(body, joined, snapping.moves(), nodes), incision.edit);
  incision.edit.moved = snapping.moves().moved();
  incision.nodes_off_plane = static_cast<int>(off.size());
  incision.volume_lost = snapping.moves().volume_lost();
  return incision;
}

}  // namespace rhexis::fracture
