#include "fracture/cut_geometry.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "mesh/nearest.h"

namespace rhexis::fracture {
namespace {

bool overlap(const mesh::BoundingBox& box, const Vec3& from, const Vec3& to) {
  return (box.from.array() <= to.array()).all() && (from.array() <= box.to.array()).all();
}

std::vector<Vec3> corners_of(const std::vector<CutTriangle>& triangles, std::size_t which) {
  std::vector<Vec3> corners;
  for (const CutTriangle& triangle : triangles) corners.push_back(triangle.corner[which]);
  return corners;
}

double squared_distance(const mesh::BoundingBox& box, const Vec3& at) {
  return (at - at.cwiseMax(box.from).cwiseMin(box.to)).squaredNorm();
}

}  // namespace

Vec3 CutTriangle::nearest(const Vec3& at) const { return mesh::nearest_in_triangle(corner, at).position; }

CutGeometry::CutGeometry(std::span<const CutSurface::Triangle> triangles, double on_plane) : on_plane_(on_plane) {
  for (const CutSurface::Triangle& t : triangles) add({t.a, t.b, t.c});
}

void CutGeometry::add(const std::array<Vec3, 3>& corner) {
  const auto& [a, b, c] = corner;
  const Vec3 normal = (b - a).cross(c - a);
  const double twice_area = normal.norm();
  if (!(twice_area > on_plane_ * on_plane_) || !std::isfinite(twice_area)) return;
  triangles_.push_back({corner, normal / twice_area, {a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c)}});
}

/// What was swept near by, of this crack and of others.
struct CutGeometry::Earlier {
  CutGeometry own;
  CutGeometry others;
};

CutGeometry CutGeometry::behind(std::span<const mesh::MeshEdit> history, double mean_edge) const {
  return earlier(history, mean_edge).own;
}

CutGeometry CutGeometry::others(std::span<const mesh::MeshEdit> history, double mean_edge) const {
  return earlier(history, mean_edge).others;
}

CutGeometry::Earlier CutGeometry::earlier(std::span<const mesh::MeshEdit> history, double mean_edge) const {
  const double gap = kJoinGap * mean_edge;
  Earlier found{CutGeometry({}, on_plane_), CutGeometry({}, on_plane_)};
  std::vector<Vec3> starts = corners_of(triangles_, 0);
  const mesh::BoundingBox wide = box(kJoinReach * mean_edge);
  for (auto edit = history.rbegin(); edit != history.rend(); ++edit) {
    CutGeometry part({}, on_plane_);
    for (const std::array<Vec3, 3>& corner : edit->swept) part.add(corner);
    const std::vector<Vec3> part_starts = corners_of(part.triangles_, 0);
    const std::vector<Vec3> part_ends = corners_of(part.triangles_, 2);
    std::erase_if(part.triangles_,
                  [&](const CutTriangle& triangle) { return !overlap(wide, triangle.box.from, triangle.box.to); });
    const bool leads_here = std::any_of(part.triangles_.begin(), part.triangles_.end(), [&](const CutTriangle& t) {
      const Vec3& b = t.corner[1];
      const Vec3& c = t.corner[2];
      const auto is_ahead = [&](const Vec3& x) {
        return std::find(part_starts.begin(), part_starts.end(), x) == part_starts.end() &&
               std::find(part_ends.begin(), part_ends.end(), x) != part_ends.end();
      };
      return is_ahead(b) && is_ahead(c) && std::any_of(starts.begin(), starts.end(), [&](const Vec3& start) {
               return (mesh::nearest_on_segment(b, c, start) - start).squaredNorm() <= gap * gap;
             });
    });
    (leads_here ? found.own : found.others).join(part);
    if (!leads_here) continue;
    starts.insert(starts.end(), part_starts.begin(), part_starts.end());
  }
  return found;
}

void CutGeometry::join(const CutGeometry& other) {
  triangles_.insert(triangles_.end(), other.triangles_.begin(), other.triangles_.end());
}

mesh::BoundingBox CutGeometry::box(double margin) const {
  mesh::BoundingBox box = triangles_.front().box;
  for (const CutTriangle& triangle : triangles_)
    box = {box.from.cwiseMin(triangle.box.from), box.to.cwiseMax(triangle.box.to)};
  return {box.from - Vec3::Constant(margin), box.to + Vec3::Constant(margin)};
}

std::vector<std::array<Vec3, 3>> CutGeometry::corners() const {
  std::vector<std::array<Vec3, 3>> all;
  for (const CutTriangle& triangle : triangles_) all.push_back(triangle.corner);
  return all;
}

std::optional<CutGeometry::Crossing> CutGeometry::crossing(const Vec3& a, const Vec3& b) const {
  const Vec3 margin = Vec3::Constant(on_plane_);
  const Vec3 from = a.cwiseMin(b) - margin;
  const Vec3 to = a.cwiseMax(b) + margin;
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    const CutTriangle& triangle = triangles_[t];
    if (!overlap(triangle.box, from, to)) continue;
    const double height_a = triangle.height(a);
    const double height_b = triangle.height(b);
    const bool a_above = height_a >= -on_plane_;
    if (a_above == (height_b >= -on_plane_)) continue;
    // (4.12). An edge almost in the plane meets it at a place that rounding moves along the edge: so much wider is the
    // triangle, lest the edge slips through between two of them.
    const double drop = std::abs(height_a - height_b);
    const Vec3 at = a + std::clamp(height_a / (height_a - height_b), 0.0, 1.0) * (b - a);
    const double rounding = 8.0 * std::numeric_limits<double>::epsilon() *
                            std::max({a.cwiseAbs().maxCoeff(), b.cwiseAbs().maxCoeff(), on_plane_});
    const double slack = 2.0 * on_plane_ + (b - a).norm() * std::min(1.0, rounding / drop);
    if ((triangle.nearest(at) - at).squaredNorm() <= slack * slack) return Crossing{t, at, a_above};
  }
  return std::nullopt;
}

const CutTriangle& CutGeometry::facing(const Vec3& at) const {
  const CutTriangle* best = &triangles_.front();
  double least = std::numeric_limits<double>::infinity();
  double steepest = 0.0;
  for (const CutTriangle& triangle : triangles_) {
    const double limit = least + on_plane_;
    if (squared_distance(triangle.box, at) > limit * limit) continue;
    const double distance = (triangle.nearest(at) - at).norm();
    if (distance > limit) continue;
    const double height = std::abs(triangle.height(at));
    if (distance < least - on_plane_ || height > steepest) {
      best = &triangle;
      steepest = height;
    }
    least = std::min(least, distance);
  }
  return *best;
}

bool CutGeometry::is_on(const Vec3& at) const {
  return std::any_of(triangles_.begin(), triangles_.end(), [&](const CutTriangle& triangle) {
    return squared_distance(triangle.box, at) <= on_plane_ * on_plane_ &&
           (triangle.nearest(at) - at).squaredNorm() <= on_plane_ * on_plane_;
  });
}

}  // namespace rhexis::fracture
