#include "fracture/snapping.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace rhexis::fracture {
namespace {

/// Snapping one node may clear the way for another, or bring an edge across a fold of the surface: it is looked at
/// anew this many times.
constexpr int kRounds = 3;

/// A move that changes the volume around a node by less than this times the cube of the mean edge keeps it: rounding of
/// some tens of tets.
constexpr double kSameVolume = 1e-12;

}  // namespace

Snapping::Snapping(const mesh::TornMesh& body, const CutGeometry& surface, const IncisionSettings& settings,
                   std::span<const TetId> near)
    : surface_(surface), edges_(edges_of(body, near)), moves_(body, {}, settings) {
  least_gain_ = kSameVolume * settings.mean_edge * settings.mean_edge * settings.mean_edge;
  std::vector<NodeId> nodes;
  for (const auto& [a, b] : edges_) nodes.insert(nodes.end(), {a, b});
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  for (const NodeId node : nodes)
    if (surface.is_on(body.mesh().node(node))) on_.insert(node);
}

std::vector<NodeId> Snapping::nodes_on() const {
  std::vector<NodeId> nodes(on_.begin(), on_.end());
  std::sort(nodes.begin(), nodes.end());
  return nodes;
}

double Snapping::height(NodeId node, std::size_t triangle) const {
  return std::abs(surface_.triangles()[triangle].height(moves_.position(node)));
}

/// Not at one of its ends. An edge with both ends on the surface needs no more.
bool Snapping::passes(const CrossedEdge& edge) const {
  return height(edge.above, edge.triangle) > surface_.on_plane() &&
         height(edge.below, edge.triangle) > surface_.on_plane() && !(is_on(edge.above) && is_on(edge.below));
}

/// Edges that go from one side to the other elsewhere than at a node on the surface. One that passes through a fold of
/// it twice is back on its side.
std::vector<CrossedEdge> Snapping::passing() const {
  std::vector<CrossedEdge> edges = crossed_edges(moves_, surface_, edges_);
  std::erase_if(edges, [&](const CrossedEdge& edge) {
    return !passes(edge) ||
           surface_.height(moves_.position(edge.above)) * surface_.height(moves_.position(edge.below)) > 0.0;
  });
  return edges;
}

std::vector<CrossedEdge> Snapping::crossed() const {
  std::vector<CrossedEdge> edges = passing();
  std::erase_if(edges, [&](const CrossedEdge& edge) { return is_on(edge.above) || is_on(edge.below); });
  return edges;
}

/// One end may have come to the surface for the sake of another edge.
bool Snapping::is_still_crossed(const CrossedEdge& edge) const {
  const auto now = surface_.crossing(moves_.position(edge.above), moves_.position(edge.below));
  return now && passes({edge.above, edge.below, now->triangle, now->at});
}

void Snapping::snap() {
  for (int round = 0; round < kRounds; ++round)
    if (!snap_once()) return;
}

bool Snapping::snap_once() {
  const std::vector<CrossedEdge> edges = passing();
  struct Turn {
    double distance = 0.0;  ///< m, of the nearer end
    std::size_t edge = 0;
    NodeId nearer;
    NodeId other;
  };
  std::vector<Turn> turns;
  std::map<NodeId, std::vector<std::size_t>> edges_of_node;
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto& [above, below, triangle, at] = edges[e];
    edges_of_node[above].push_back(e);
    edges_of_node[below].push_back(e);
    const double high = height(above, triangle);
    const double low = height(below, triangle);
    turns.push_back(high <= low ? Turn{high, e, above, below} : Turn{low, e, below, above});
  }
  std::stable_sort(turns.begin(), turns.end(), [](const Turn& a, const Turn& b) { return a.distance < b.distance; });

  bool moved = false;
  for (const Turn& turn : turns) {
    if (!is_still_crossed(edges[turn.edge])) continue;
    for (const NodeId end : {turn.nearer, turn.other}) {
      if (is_on(end) || !bring(end, edges, edges_of_node[end])) continue;
      on_.insert(end);
      moved = true;
      break;
    }
  }
  return moved;
}

/// To the foot on the surface if that leaves the volume as it is (inside the body, or along a flat side), else to where
/// one of its edges passes through the surface; of several places the one that changes the volume least.
bool Snapping::bring(NodeId node, std::span<const CrossedEdge> edges, const std::vector<std::size_t>& own) {
  if (!moves_.is_movable(node)) return false;
  const Vec3 at = moves_.position(node);
  std::vector<std::pair<double, Vec3>> places;
  const Vec3 foot = surface_.facing(at).projected(at);
  if (surface_.is_on(foot)) places.emplace_back(0.0, foot);
  for (const std::size_t edge : own) places.emplace_back(0.0, edges[edge].at);
  for (auto& [gain, place] : places) {
    gain = std::abs(moves_.volume_gain(node, place));
    if (gain < least_gain_) gain = 0.0;
  }
  std::stable_sort(places.begin(), places.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  return std::any_of(places.begin(), places.end(), [&](const auto& place) { return moves_.move(node, place.second); });
}

}  // namespace rhexis::fracture
