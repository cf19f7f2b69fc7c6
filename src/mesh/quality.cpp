#include "mesh/quality.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Dense>

namespace rhexis::mesh {
namespace {

/// Collects values one by one; a plain running sum, in the order of the mesh, so that it repeats bit by bit.
class Collector {
 public:
  void add(double value) {
    min_ = std::min(min_, value);
    max_ = std::max(max_, value);
    sum_ += value;
    ++count_;
  }
  [[nodiscard]] Range range() const {
    return count_ == 0 ? Range{} : Range{min_, sum_ / static_cast<double>(count_), max_};
  }

 private:
  double min_ = std::numeric_limits<double>::infinity();
  double max_ = -std::numeric_limits<double>::infinity();
  double sum_ = 0.0;
  std::size_t count_ = 0;
};

/// Degrees between the faces that meet at the edge (p, q); r and s are the other two corners. The angle between the
/// parts of r - p and s - p across the edge, by atan2, which stays exact near 0 and 180 degrees where acos does not.
double dihedral_angle(const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& s) {
  const Vec3 along = q - p;
  const Vec3 u = along.cross(r - p);
  const Vec3 v = along.cross(s - p);
  return std::atan2(u.cross(v).norm(), u.dot(v)) * (180.0 / std::numbers::pi);
}

/// The distinct edges of the mesh as (smaller, larger) node, ascending.
std::vector<std::pair<NodeId, NodeId>> distinct_edges(const TetMesh& mesh) {
  std::vector<std::pair<NodeId, NodeId>> edges;
  edges.reserve(6 * mesh.tet_count());
  for (const Tet& tet : mesh.tets)
    for (const auto& [i, j] : kTetEdges) edges.push_back(std::minmax(tet[i], tet[j]));
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

/// Six volumes below this part of a cubed edge are the rounding of coordinates: the tet is flat.
constexpr double kFlatVolume = 1e-14;

}  // namespace

double radius_ratio(const std::array<Vec3, 4>& x) {
  const Vec3 a = x[1] - x[0];
  const Vec3 b = x[2] - x[0];
  const Vec3 c = x[3] - x[0];
  const double six_volumes = a.cross(b).dot(c);
  const double twice_area = a.cross(b).norm() + b.cross(c).norm() + c.cross(a).norm() + (b - a).cross(c - a).norm();
  // r_in = 3 V / A and r_circ = |a^2 b x c + b^2 c x a + c^2 a x b| / (12 V)
  const double circum =
      (a.squaredNorm() * b.cross(c) + b.squaredNorm() * c.cross(a) + c.squaredNorm() * a.cross(b)).norm();
  // Where two corners have come together both volume and circumsphere are rounding, and so would be their ratio.
  const double size = std::max({a.norm(), b.norm(), c.norm()});
  if (std::abs(six_volumes) <= kFlatVolume * size * size * size) return 0.0;
  return std::min(1.0, 6.0 * six_volumes * six_volumes / (twice_area * circum));
}

Quality measure_quality(const TetMesh& mesh) {
  Collector dihedral;
  Collector ratio;
  Collector volume;
  for (std::size_t t = 0; t < mesh.tet_count(); ++t) {
    const std::array<Vec3, 4> x = corners(mesh, TetId(t));
    for (const auto& [i, j] : kTetEdges) {
      const int k = i != 0 && j != 0 ? 0 : (i != 1 && j != 1 ? 1 : 2);
      dihedral.add(dihedral_angle(x[i], x[j], x[k], x[6 - i - j - k]));
    }
    ratio.add(radius_ratio(x));
    volume.add(signed_volume(mesh, TetId(t)));
  }
  Collector edge;
  for (const auto& [i, j] : distinct_edges(mesh)) edge.add((mesh.node(i) - mesh.node(j)).norm());
  return {dihedral.range(), ratio.range(), edge.range(), volume.range()};
}

}  // namespace rhexis::mesh
