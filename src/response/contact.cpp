#include "response/contact.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "mesh/nearest.h"

namespace rhexis::response {
namespace {

using mesh::TetFace;
using mesh::TornMesh;

std::array<Vec3, 3> corners_of(const TornMesh& body, TetFace face) {
  const auto nodes = mesh::face_nodes(body.mesh(), face);
  return {body.mesh().node(nodes[0]), body.mesh().node(nodes[1]), body.mesh().node(nodes[2])};
}

struct Nearest {
  TetFace face;
  mesh::TrianglePoint point;
  double squared_distance = std::numeric_limits<double>::infinity();
};

/// By going through all tets: what is further away than the best so far costs a comparison of boxes. The first of
/// several as near wins.
Nearest find_nearest(const TornMesh& body, const Vec3& at) {
  Nearest best;
  for (std::size_t t = 0; t < body.mesh().tet_count(); ++t) {
    const TetId tet(t);
    if (!body.is_solved(tet)) continue;
    const auto x = mesh::corners(body.mesh(), tet);
    const Vec3 low = x[0].cwiseMin(x[1]).cwiseMin(x[2].cwiseMin(x[3]));
    const Vec3 high = x[0].cwiseMax(x[1]).cwiseMax(x[2].cwiseMax(x[3]));
    if ((at - at.cwiseMax(low).cwiseMin(high)).squaredNorm() >= best.squared_distance) continue;
    for (std::int8_t vertex = 0; vertex < 4; ++vertex) {
      const TetFace face{tet, vertex};
      const mesh::TrianglePoint point = mesh::nearest_in_triangle(corners_of(body, face), at);
      const double squared = (point.position - at).squaredNorm();
      if (squared < best.squared_distance && mesh::is_on_solved_surface(body, face)) best = {face, point, squared};
    }
  }
  return best;
}

/// Of the surface faces that have all nodes of the point, each weighted by its angle there, so that the normal at a
/// vertex does not depend on how the sides around it are cut into triangles.
Vec3 outward_normal(const TornMesh& body, const SurfacePoint& point) {
  Vec3 sum = Vec3::Zero();
  for (const TetId tet : body.tets_around(point.node[0])) {
    if (!body.is_solved(tet)) continue;
    for (std::int8_t vertex = 0; vertex < 4; ++vertex) {
      const TetFace face{tet, vertex};
      const auto nodes = mesh::face_nodes(body.mesh(), face);
      const auto place = [&](NodeId node) {
        return static_cast<std::size_t>(std::find(nodes.begin(), nodes.end(), node) - nodes.begin());
      };
      bool has_all = true;
      for (int k = 0; k < point.count; ++k) has_all = has_all && place(point.node[static_cast<std::size_t>(k)]) < 3;
      if (!has_all || !mesh::is_on_solved_surface(body, face)) continue;
      const auto corner = corners_of(body, face);
      const std::size_t here = place(point.node[0]);
      const Vec3 one = corner[(here + 1) % 3] - corner[here];
      const Vec3 other = corner[(here + 2) % 3] - corner[here];
      const Vec3 area = one.cross(other);
      const double angle = point.count == 1 ? std::atan2(area.norm(), one.dot(other)) : 1.0;
      if (area.norm() > 0.0) sum += angle * area.normalized();
    }
  }
  return sum.norm() > 0.0 ? Vec3(sum.normalized()) : Vec3(Vec3::UnitZ());
}

}  // namespace

std::optional<SurfacePoint> nearest_surface_point(const TornMesh& body, const Vec3& at, double snap) {
  const Nearest nearest = find_nearest(body, at);
  if (!std::isfinite(nearest.squared_distance)) return std::nullopt;
  const auto nodes = mesh::face_nodes(body.mesh(), nearest.face);
  const auto corner = corners_of(body, nearest.face);
  Vec3 weight = nearest.point.weight;
  const Vec3& foot = nearest.point.position;
  Eigen::Index closest = 0;
  weight.maxCoeff(&closest);
  for (Eigen::Index k = 0; k < 3; ++k) {
    const auto distance = [&](Eigen::Index i) { return (corner[static_cast<std::size_t>(i)] - foot).norm(); };
    if (distance(k) < distance(closest)) closest = k;
  }
  if ((corner[static_cast<std::size_t>(closest)] - foot).norm() <= snap) weight = Vec3::Unit(closest);

  SurfacePoint point;
  point.weight.setZero();
  for (std::size_t k = 0; k < 3; ++k) {
    const double share = weight[static_cast<Eigen::Index>(k)];
    if (share <= 0.0) continue;
    point.node[static_cast<std::size_t>(point.count)] = nodes[k];
    point.weight[point.count] = share;
    point.position += share * corner[k];
    ++point.count;
  }
  point.normal = outward_normal(body, point);
  return point;
}

}  // namespace rhexis::response
