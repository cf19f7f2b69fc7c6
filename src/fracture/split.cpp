#include "fracture/split.h"

#include <algorithm>
#include <iterator>
#include <unordered_map>

#include "fracture/face_neighbours.h"
#include "fracture/node_doubling.h"
#include "fracture/snapping.h"

namespace rhexis::fracture {
namespace {

/// On which side of the surface the tets are, as far as asked.
class Sides {
 public:
  Sides(const mesh::TornMesh& body, const CutGeometry& surface, const Snapping& snapping)
      : body_(body), surface_(surface), snapping_(snapping) {}

  /// By the corners off the surface, which are on one side of it unless an edge could not be kept from crossing: then
  /// by the middle.
  bool is_above(TetId tet) {
    const auto [at, is_new] = tets_.try_emplace(tet, false);
    if (!is_new) return at->second;
    int above = 0;
    int below = 0;
    Vec3 middle = Vec3::Zero();
    for (const NodeId node : body_.mesh().tet(tet)) {
      middle += 0.25 * snapping_.moves().position(node);
      if (!snapping_.is_on(node)) ++(is_above(node) ? above : below);
    }
    const bool by_corners = (above == 0) != (below == 0);
    at->second = by_corners ? above > 0 : surface_.height(middle) >= 0.0;
    return at->second;
  }

 private:
  bool is_above(NodeId node) {
    const auto [at, is_new] = nodes_.try_emplace(node, false);
    if (is_new) at->second = surface_.height(snapping_.moves().position(node)) >= 0.0;
    return at->second;
  }

  const mesh::TornMesh& body_;
  const CutGeometry& surface_;
  const Snapping& snapping_;
  std::unordered_map<TetId, bool> tets_;
  std::unordered_map<NodeId, bool> nodes_;
};

/// Faces of `nodes` (ascending) between tets above and below. Both sides of each, ascending.
std::vector<mesh::TetFace> faces_between(const mesh::TornMesh& body, Sides sides, const std::vector<NodeId>& nodes) {
  std::vector<TetId> tets;
  for (const NodeId node : nodes) tets.insert(tets.end(), body.tets_around(node).begin(), body.tets_around(node).end());
  std::sort(tets.begin(), tets.end());

  std::vector<mesh::TetFace> faces;
  for (auto at = tets.begin(); at != tets.end();) {
    const TetId tet = *at;
    const auto next = std::upper_bound(at, tets.end(), tet);
    const auto corners = next - at;  // that are among the nodes
    at = next;
    if (corners < 3 || !body.is_solved(tet)) continue;
    for (std::int8_t k = 0; k < 4; ++k) {
      const mesh::TetFace face{tet, k};
      const std::array<NodeId, 3> n = mesh::face_nodes(body.mesh(), face);
      const auto is_one = [&](NodeId node) { return std::binary_search(nodes.begin(), nodes.end(), node); };
      if (!std::all_of(n.begin(), n.end(), is_one)) continue;
      const TetId other = tet_across(body, face);
      if (other.valid() && sides.is_above(tet) != sides.is_above(other)) faces.push_back(face);
    }
  }
  return faces;
}

}  // namespace

Incision incise_splitting(const mesh::TornMesh& body, const Surroundings& surroundings, const CutGeometry& surface,
                          const IncisionSettings& settings) {
  const CutGeometry behind = surface.behind(body.history(), settings.mean_edge);
  CutGeometry joined = surface;
  joined.join(behind);
  const std::vector<TetId> near = tets_near(body, surroundings, joined, surface.box(kJoinReach * settings.mean_edge));
  Snapping snapping(body, joined, settings, near);

  Incision incision;
  std::vector<CrossedEdge> edges = crossed_edges(snapping.moves(), surface, edges_of(body, near));
  // The crack has been at those: the line between the old surface and the new one is on both.
  std::erase_if(edges, [&](const CrossedEdge& edge) { return behind.is_on(body.mesh().node(edge.above)); });
  if (edges.empty()) return {};
  incision.edges_cut = static_cast<int>(edges.size());

  snapping.snap();
  // Where an edge is still crossed, the faces go round it: its ends count as the crack's.
  const std::vector<NodeId> on = snapping.nodes_on();
  const std::vector<NodeId> off = ends_of(snapping.crossed());
  std::vector<NodeId> nodes;
  std::set_union(on.begin(), on.end(), off.begin(), off.end(), std::back_inserter(nodes));
  double_nodes(body, faces_between(body, Sides(body, joined, snapping), nodes), incision.edit);
  // Short of the next nodes, or along a gap that is there already: what was snapped comes with what opens something.
  if (incision.edit.copied.empty()) return {};
  incision.edit.moved = snapping.moves().moved();
  incision.edit.swept = surface.corners();
  incision.nodes_off_plane = static_cast<int>(off.size());
  incision.volume_lost = snapping.moves().volume_lost();
  return incision;
}

}  // namespace rhexis::fracture
