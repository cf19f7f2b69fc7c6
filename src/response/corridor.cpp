#include "response/corridor.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace rhexis::response {
namespace {

double mean_edge(const mesh::TornMesh& body) {
  double sum = 0.0;
  std::size_t edges = 0;
  for (std::size_t t = 0; t < body.mesh().tet_count(); ++t) {
    if (!body.is_solved(TetId(t))) continue;
    const auto x = mesh::corners(body.mesh(), TetId(t));
    for (const auto& [a, b] : mesh::kTetEdges)
      sum += (x[static_cast<std::size_t>(a)] - x[static_cast<std::size_t>(b)]).norm();
    edges += mesh::kTetEdges.size();
  }
  return edges > 0 ? sum / static_cast<double>(edges) : 0.0;
}

/// A slab about the plane in which the front runs, or a rod where that plane is not known; through the whole body,
/// since the large separators are as long.
bool is_in_corridor(const Focus& focus, double half_width, const Vec3& x) {
  const Vec3 from = x - focus.centre;
  const Vec3 across = from - from.dot(focus.direction) * focus.direction;
  const double side = focus.half_length + half_width;
  const Vec3 normal = focus.tangent.cross(focus.direction);
  if (normal.norm() < 0.5) return across.norm() <= side;
  return std::abs(across.dot(normal)) <= half_width && std::abs(across.dot(focus.tangent)) <= side;
}

}  // namespace

std::vector<std::int32_t> separator_weights(const mesh::TornMesh& body, std::span<const Focus> focus) {
  const double half_width = kCorridorEdges * mean_edge(body);
  std::vector<std::int32_t> out(body.mesh().node_count(), 1);
  for (std::size_t i = 0; i < out.size(); ++i) {
    const bool inside = std::any_of(focus.begin(), focus.end(), [&](const Focus& each) {
      return each.direction.norm() > 0.5 && is_in_corridor(each, half_width, body.mesh().nodes[i]);
    });
    if (inside) out[i] = kCorridorWeight;
  }
  return out;
}

std::vector<std::int32_t> nodes_ahead(const mesh::TornMesh& body, std::span<const Focus> focus) {
  std::vector<std::int32_t> out;
  for (std::size_t i = 0; i < body.mesh().node_count(); ++i) {
    const bool ahead = std::any_of(focus.begin(), focus.end(), [&](const Focus& each) {
      const Vec3 from = body.mesh().nodes[i] - each.centre;
      const double along = from.dot(each.direction);
      const double aside = std::max(0.0, std::abs(from.dot(each.tangent)) - each.half_length);
      const Vec3 in_plane = from - from.dot(each.tangent) * each.tangent;
      return along > 0.0 && std::hypot(in_plane.norm(), aside) <= 0.5 * each.radius;
    });
    if (ahead) out.push_back(static_cast<std::int32_t>(i));
  }
  return out;
}

}  // namespace rhexis::response
