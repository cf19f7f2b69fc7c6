#pragma once

/// A triangulation of a plane region with a fixed rim, kept Delaunay by edge flips while points come in and move.

#include <array>
#include <vector>

#include <Eigen/Core>

namespace rhexis::mesh {

using Point2 = Eigen::Vector2d;
using Triangle = std::array<int, 3>;  ///< counter-clockwise

/// Lengths are meant to be in units of the edge length aimed at: the tolerances inside are absolute.
class Triangulation {
 public:
  /// A convex polygon, counter-clockwise, and one point inside it, which becomes the point after the rim's.
  /// Rim points may lie on a straight line.
  static Triangulation fan(std::vector<Point2> rim, const Point2& inside);
  /// The region between two closed lines around the origin, both counter-clockwise with ascending angles in [0, 2 pi).
  /// The outer points come first.
  static Triangulation ring(std::vector<Point2> outer, const std::vector<Point2>& inner);

  /// Adds a point of the inside of the region. One that would lie on an edge, to rounding, is moved off it by a little.
  void insert(Point2 point);

  /// Moves the points that are not on the rim towards where the triangles around them would be best shaped, `sweeps`
  /// times (optimal Delaunay smoothing: the area-weighted mean of the circumcentres around each point), restoring
  /// the Delaunay property after each sweep. No triangle turns over.
  void smooth(int sweeps);

  [[nodiscard]] const std::vector<Point2>& points() const { return points_; }
  [[nodiscard]] const std::vector<Triangle>& triangles() const { return triangles_; }

 private:
  explicit Triangulation(std::vector<Point2> points) : points_(std::move(points)), rim_count_(points_.size()) {}
  void connect();
  [[nodiscard]] double area2(int a, int b, int c) const;
  [[nodiscard]] std::size_t locate(const Point2& point) const;
  [[nodiscard]] bool wants_flip(std::size_t t, std::size_t k) const;
  void flip(std::size_t t, std::size_t k);
  void replace_neighbour(int triangle, int old_neighbour, int new_neighbour);
  void flip_around(std::vector<std::pair<std::size_t, std::size_t>> suspects);
  void flip_everywhere();
  void keep_upright(const std::vector<Point2>& before);

  std::vector<Point2> points_;
  std::size_t rim_count_;  ///< the first points, which never move
  std::vector<Triangle> triangles_;
  std::vector<std::array<int, 3>> neighbours_;  ///< across the edge opposite to each vertex; -1 at the rim
  std::size_t last_ = 0;                        ///< where the last search ended; the next one is often near
};

}  // namespace rhexis::mesh
