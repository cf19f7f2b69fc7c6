#include "fracture/node_moves.h"

#include <algorithm>

#include <Eigen/Geometry>

#include "mesh/quality.h"

namespace rhexis::fracture {
namespace {

double signed_volume_of(const std::array<Vec3, 4>& x) {
  return (x[1] - x[0]).cross(x[2] - x[0]).dot(x[3] - x[0]) / 6.0;
}

}  // namespace

const Vec3& NodeMoves::position(NodeId node) const {
  const auto at = moved_.find(node);
  return at == moved_.end() ? body_.mesh().node(node) : at->second;
}

bool NodeMoves::is_movable(NodeId node) const {
  if (settings_.immovable[node.index()] != 0) return false;
  const auto tets = body_.tets_around(node);
  return std::none_of(tets.begin(), tets.end(), [&](TetId tet) { return body_.is_frozen(tet); });
}

bool NodeMoves::is_removed(TetId tet) const { return std::binary_search(removed_.begin(), removed_.end(), tet); }

bool NodeMoves::remains(NodeId node) const {
  const auto tets = body_.tets_around(node);
  return std::any_of(tets.begin(), tets.end(), [&](TetId tet) { return !is_removed(tet); });
}

std::array<Vec3, 4> NodeMoves::corners(TetId tet, NodeId node, const Vec3& to) const {
  std::array<Vec3, 4> x;
  const mesh::Tet& nodes = body_.mesh().tet(tet);
  for (std::size_t k = 0; k < 4; ++k) x[k] = nodes[k] == node ? to : position(nodes[k]);
  return x;
}

bool NodeMoves::allows(TetId tet, const std::array<Vec3, 4>& x) const {
  if (!(signed_volume_of(x) > 0.0)) return false;
  const double ratio = mesh::radius_ratio(x);
  return ratio >= kFlattestTet * settings_.smallest_radius_ratio ||
         ratio >= mesh::radius_ratio(mesh::corners(body_.mesh(), tet));
}

bool NodeMoves::move(NodeId node, const Vec3& to) {
  for (const TetId tet : body_.tets_around(node))
    if (!is_removed(tet) && !allows(tet, corners(tet, node, to))) return false;
  moved_[node] = to;
  return true;
}

bool NodeMoves::move_towards(NodeId node, const Vec3& to) {
  if (move(node, to)) return true;
  const Vec3 from = position(node);
  for (const double part : {0.5, 0.25, 0.125})
    if (move(node, from + part * (to - from))) break;
  return false;
}

double NodeMoves::volume_gain(NodeId node, const Vec3& to) const {
  double gain = 0.0;
  const Vec3 from = position(node);
  for (const TetId tet : body_.tets_around(node))
    if (!is_removed(tet)) gain += signed_volume_of(corners(tet, node, to)) - signed_volume_of(corners(tet, node, from));
  return gain;
}

std::vector<mesh::MovedNode> NodeMoves::moved() const {
  std::vector<mesh::MovedNode> all;
  for (const auto& [node, to] : moved_)
    if (to != body_.mesh().node(node)) all.push_back({node, body_.mesh().node(node), to});
  std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.node < b.node; });
  return all;
}

double NodeMoves::volume_lost() const {
  std::vector<TetId> touched(removed_.begin(), removed_.end());
  for (const auto& [node, to] : moved_)
    touched.insert(touched.end(), body_.tets_around(node).begin(), body_.tets_around(node).end());
  std::sort(touched.begin(), touched.end());
  touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
  double lost = 0.0;
  for (const TetId tet : touched) {
    lost += mesh::signed_volume(body_.mesh(), tet);
    if (!is_removed(tet)) lost -= signed_volume_of(corners(tet, NodeId(), Vec3::Zero()));
  }
  return lost;
}

}  // namespace rhexis::fracture
