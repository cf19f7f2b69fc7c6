#include "fracture/front_surroundings.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>

#include "mesh/nearest.h"
#include "mesh/quality.h"
#include "mesh/surface.h"

namespace rhexis::fracture {
namespace {

/// A cell of the grid, in mean edges: few tets outside of what is asked, few empty cells.
constexpr double kCell = 1.5;
/// A body is a plate when its height is at most this part of its smaller side ...
constexpr double kThin = 0.25;
/// ... and its surface triangles are level or upright to this (sine of the angle, part of the height).
constexpr double kLevel = 1e-3;
/// Gaps on a line below this, in mean edges, are rounding between neighbours; so are barycentric coordinates below it.
constexpr double kGap = 1e-7;

/// The part of the way a..b in the closed tet; empty (from > to) when there is none.
Surroundings::Interval clip(const std::array<Vec3, 4>& x, const Vec3& a, const Vec3& b) {
  Mat3 edges;
  for (int k = 0; k < 3; ++k) edges.col(k) = x[static_cast<std::size_t>(k) + 1] - x[0];
  const Mat3 inverse = edges.inverse();
  const Vec3 at_a = inverse * (a - x[0]);
  const Vec3 at_b = inverse * (b - x[0]);
  Surroundings::Interval part{0.0, 1.0};
  for (int k = 0; k < 4; ++k) {
    const double va = kGap + (k < 3 ? at_a[k] : 1.0 - at_a.sum());
    const double vb = kGap + (k < 3 ? at_b[k] : 1.0 - at_b.sum());
    if (va < 0.0 && vb < 0.0) return {1.0, 0.0};
    if (va < 0.0) part.from = std::max(part.from, va / (va - vb));
    if (vb < 0.0) part.to = std::min(part.to, va / (va - vb));
  }
  return part;
}

/// The part of the way a..b in the box; empty (from > to) when there is none.
Surroundings::Interval clip(const mesh::BoundingBox& box, const Vec3& a, const Vec3& b) {
  Surroundings::Interval part{0.0, 1.0};
  for (int k = 0; k < 3; ++k) {
    for (const double side : {1.0, -1.0}) {
      const double va = side > 0.0 ? a[k] - box.from[k] : box.to[k] - a[k];
      const double vb = side > 0.0 ? b[k] - box.from[k] : box.to[k] - b[k];
      if (va < 0.0 && vb < 0.0) return {1.0, 0.0};
      if (va < 0.0) part.from = std::max(part.from, va / (va - vb));
      if (vb < 0.0) part.to = std::min(part.to, va / (va - vb));
    }
  }
  return part;
}

bool is_thin_extrusion(const mesh::TetMesh& mesh, const std::vector<mesh::TetFace>& surface,
                       const mesh::BoundingBox& box) {
  const Vec3 size = box.size();
  if (size[2] > kThin * std::min(size[0], size[1])) return false;
  for (const mesh::TetFace& face : surface) {
    const std::array<NodeId, 3> nodes = mesh::face_nodes(mesh, face);
    const Vec3& x = mesh.node(nodes[0]);
    const double slope = (mesh.node(nodes[1]) - x).cross(mesh.node(nodes[2]) - x).normalized().cwiseAbs()[2];
    const double off_level = std::min(std::abs(x[2] - box.from[2]), std::abs(x[2] - box.to[2]));
    const bool level = slope > 1.0 - kLevel && off_level < kLevel * size[2];
    if (!level && slope > kLevel) return false;
  }
  return true;
}

}  // namespace

Surroundings::Surroundings(const mesh::TetMesh& intact)
    : nodes_(intact.nodes), tets_(intact.tets), box_(mesh::bounding_box(intact)) {
  mean_edge_ = mesh::measure_quality(intact).edge.mean;
  const std::vector<mesh::TetFace> boundary = mesh::find_faces(intact).boundary;
  for (const mesh::TetFace& face : boundary) {
    const std::array<NodeId, 3> nodes = mesh::face_nodes(intact, face);
    surface_.push_back({{nodes_[nodes[0].index()], nodes_[nodes[1].index()], nodes_[nodes[2].index()]}});
  }
  plate_ = is_thin_extrusion(intact, boundary, box_);

  const Vec3 size = box_.size();
  cell_ = kCell * mean_edge_;
  // A long thin body of few tets must not ask for more cells than a few per tet.
  while (size[0] / cell_ * (size[1] / cell_) * (size[2] / cell_) > 4.0 * static_cast<double>(tets_.size()) + 64.0)
    cell_ *= 1.25;
  for (std::size_t k = 0; k < 3; ++k)
    cells_[k] = std::max(1, static_cast<int>(std::ceil(size[static_cast<Eigen::Index>(k)] / cell_)));

  std::vector<std::int32_t> cell_of(tets_.size());
  cell_start_.assign(
      static_cast<std::size_t>(cells_[0]) * static_cast<std::size_t>(cells_[1]) * static_cast<std::size_t>(cells_[2]) +
          1,
      0);
  for (std::size_t tet = 0; tet < tets_.size(); ++tet) {
    Vec3 centroid = Vec3::Zero();
    for (const NodeId node : tets_[tet]) centroid += 0.25 * nodes_[node.index()];
    for (const NodeId node : tets_[tet]) reach_ = std::max(reach_, (nodes_[node.index()] - centroid).norm());
    std::int32_t cell = 0;
    for (int k = 2; k >= 0; --k) {
      const int at = static_cast<int>((centroid[k] - box_.from[k]) / cell_);
      cell = cell * cells_[static_cast<std::size_t>(k)] + std::clamp(at, 0, cells_[static_cast<std::size_t>(k)] - 1);
    }
    cell_of[tet] = cell;
    ++cell_start_[static_cast<std::size_t>(cell) + 1];
  }
  for (std::size_t cell = 1; cell < cell_start_.size(); ++cell) cell_start_[cell] += cell_start_[cell - 1];
  cell_tets_.resize(tets_.size());
  std::vector<std::int32_t> next(cell_start_.begin(), cell_start_.end() - 1);
  for (std::size_t tet = 0; tet < tets_.size(); ++tet)
    cell_tets_[static_cast<std::size_t>(next[static_cast<std::size_t>(cell_of[tet])]++)] =
        static_cast<std::int32_t>(tet);
}

/// Every tet whose intact centroid is in a cell that meets the box from..to (m).
template <class Use>
void Surroundings::visit(const Vec3& from, const Vec3& to, Use&& use) const {
  std::array<int, 3> first{};
  std::array<int, 3> last{};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    const auto cell_at = [&](double x) {
      return static_cast<int>(std::clamp(std::floor((x - box_.from[i]) / cell_), 0.0, cells_[k] - 1.0));
    };
    first[k] = cell_at(from[i]);
    last[k] = cell_at(to[i]);
  }
  for (int z = first[2]; z <= last[2]; ++z) {
    for (int y = first[1]; y <= last[1]; ++y) {
      const auto row = static_cast<std::size_t>((z * cells_[1] + y) * cells_[0]);
      const auto begin = static_cast<std::size_t>(cell_start_[row + static_cast<std::size_t>(first[0])]);
      const auto end = static_cast<std::size_t>(cell_start_[row + static_cast<std::size_t>(last[0]) + 1]);
      for (std::size_t at = begin; at < end; ++at) use(TetId(cell_tets_[at]));
    }
  }
}

void Surroundings::follow(const mesh::MeshEdit& edit, const mesh::TornMesh& body) {
  for (const mesh::MovedNode& move : edit.moved) {
    const Vec3& intact = nodes_[body.original(move.node).index()];
    drift_ = std::max(drift_, (move.to - intact).norm());
  }
}

std::vector<TetId> Surroundings::tets_near(const mesh::TornMesh& body, const Crack& crack, double radius) const {
  Vec3 from = crack.front.front().position;
  Vec3 to = from;
  for (const FrontPoint& point : crack.front) {
    from = from.cwiseMin(point.position);
    to = to.cwiseMax(point.position);
  }
  const Vec3 wide = Vec3::Constant(radius + drift_);
  std::vector<TetId> near;
  visit(from - wide, to + wide, [&](TetId tet) {
    if (!body.is_solved(tet)) return;
    Vec3 centroid = Vec3::Zero();
    for (const NodeId node : body.mesh().tet(tet)) centroid += 0.25 * body.mesh().node(node);
    for (std::size_t i = 0; i + 1 < crack.front.size(); ++i) {
      if ((mesh::nearest_on_segment(crack.front[i].position, crack.front[i + 1].position, centroid) - centroid).norm() >
          radius)
        continue;
      near.push_back(tet);
      return;
    }
  });
  std::sort(near.begin(), near.end());
  return near;
}

std::vector<TetId> Surroundings::tets_meeting(const mesh::TornMesh& body, const Vec3& from, const Vec3& to) const {
  const Vec3 wide = Vec3::Constant(reach_ + drift_);
  std::vector<TetId> meeting;
  visit(from - wide, to + wide, [&](TetId tet) {
    if (!body.is_solved(tet)) return;
    const std::array<Vec3, 4> x = mesh::corners(body.mesh(), tet);
    const Vec3 low = x[0].cwiseMin(x[1]).cwiseMin(x[2].cwiseMin(x[3]));
    const Vec3 high = x[0].cwiseMax(x[1]).cwiseMax(x[2].cwiseMax(x[3]));
    if ((low.array() <= to.array()).all() && (from.array() <= high.array()).all()) meeting.push_back(tet);
  });
  std::sort(meeting.begin(), meeting.end());
  return meeting;
}

std::vector<Surroundings::Interval> Surroundings::inside(const Vec3& a, const Vec3& b) const {
  // Near the body, however long the line; and in pieces, so that the boxes around them stay small beside the body.
  const Vec3 margin = Vec3::Constant(mean_edge_);
  const Interval near = clip(mesh::BoundingBox{box_.from - margin, box_.to + margin}, a, b);
  if (!(near.from <= near.to)) return {};
  const double length = (b - a).norm();
  const double share = near.to - near.from;
  const int pieces = std::max(1, static_cast<int>(std::ceil(share * length / (4.0 * cell_))));
  const auto place = [&](double piece) { return near.from + share * (piece / pieces); };  // part of the way
  std::vector<Interval> parts;
  const Vec3 wide = Vec3::Constant(reach_);
  for (int piece = 0; piece < pieces; ++piece) {
    const Vec3 from = a + (b - a) * place(piece);
    const Vec3 to = a + (b - a) * place(piece + 1);
    visit(from.cwiseMin(to) - wide, from.cwiseMax(to) + wide, [&](TetId tet) {
      std::array<Vec3, 4> x;
      for (std::size_t k = 0; k < 4; ++k) x[k] = nodes_[tets_[tet.index()][k].index()];
      const Interval part = clip(x, from, to);
      if (part.to >= part.from) parts.push_back({place(piece + part.from), place(piece + part.to)});
    });
  }
  std::sort(parts.begin(), parts.end(),
            [](const Interval& l, const Interval& r) { return l.from < r.from || (l.from == r.from && l.to < r.to); });
  const double gap = length > 0.0 ? kGap * mean_edge_ / length : 0.0;
  std::vector<Interval> merged;
  for (const Interval& part : parts) {
    if (!merged.empty() && part.from <= merged.back().to + gap)
      merged.back().to = std::max(merged.back().to, part.to);
    else
      merged.push_back(part);
  }
  return merged;
}

bool Surroundings::is_inside(const Vec3& at) const { return !inside(at, at).empty(); }

Vec3 Surroundings::nearest_on_surface(const Vec3& at) const {
  double least = std::numeric_limits<double>::infinity();
  Vec3 nearest = at;
  for (const Triangle& triangle : surface_) {
    // A corner further off than the nearest so far and a whole edge: not this one.
    const double corner = (triangle.corner[0] - at).norm();
    if (corner - 2.0 * reach_ > least) continue;
    const Vec3 candidate = mesh::nearest_in_triangle(triangle.corner, at).position;
    const double distance = (candidate - at).norm();
    if (distance < least) {
      least = distance;
      nearest = candidate;
    }
  }
  return nearest;
}

}  // namespace rhexis::fracture
