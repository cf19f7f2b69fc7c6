#pragma once

/// The swept surface as incision sees it: sides of points, and where edges pass through it.

#include <optional>
#include <span>
#include <vector>

#include "fracture/crack.h"
#include "mesh/mesh_edit.h"

namespace rhexis::fracture {

/// How far behind an incision its crack is looked at again, in mean edges. A front stands between nodes: the last faces
/// behind it still hang together at their nodes, and come apart when the crack has gone past these.
inline constexpr double kJoinReach = 2.0;
/// A front may be smoothed and given other points between two incisions, by less than this many mean edges.
inline constexpr double kJoinGap = 0.5;

/// One triangle with its plane. Distances are signed, positive above.
struct CutTriangle {
  std::array<Vec3, 3> corner;
  Vec3 normal = Vec3::Zero();  ///< unit
  mesh::BoundingBox box;

  [[nodiscard]] double height(const Vec3& at) const { return normal.dot(at - corner[0]); }
  /// Onto the plane, (4.13).
  [[nodiscard]] Vec3 projected(const Vec3& at) const { return at - height(at) * normal; }
  /// The point of the triangle nearest to `at`.
  [[nodiscard]] Vec3 nearest(const Vec3& at) const;
};

class CutGeometry {
 public:
  /// `on_plane`, m: a point closer to the surface than this is on it, and counts as above. Triangles without an area
  /// (or whose area is not a number) are left out.
  CutGeometry(std::span<const CutSurface::Triangle> triangles, double on_plane);

  /// The crack that leads to this surface: what earlier edits swept within kJoinReach of it, and whose front (b to c of
  /// their triangles, see CutSurface) is no further than kJoinGap from where this one starts, or one of those. Not
  /// other cracks that it meets: what is above those may be below this one. `mean_edge` in m.
  [[nodiscard]] CutGeometry behind(std::span<const mesh::MeshEdit> history, double mean_edge) const;
  /// The other cracks: what earlier edits swept within kJoinReach of this surface and `behind` leaves out.
  [[nodiscard]] CutGeometry others(std::span<const mesh::MeshEdit> history, double mean_edge) const;
  /// Adds the triangles of the other, behind its own.
  void join(const CutGeometry& other);

  [[nodiscard]] const std::vector<CutTriangle>& triangles() const { return triangles_; }
  [[nodiscard]] double on_plane() const { return on_plane_; }
  /// Around all triangles, wider by `margin` (m) on each side. There must be one.
  [[nodiscard]] mesh::BoundingBox box(double margin) const;
  /// What MeshEdit::swept takes.
  [[nodiscard]] std::vector<std::array<Vec3, 3>> corners() const;

  /// Where the edge from `a` to `b` passes through the surface, one end above and one below: the triangle and the
  /// point. Inclusive: what passes between two triangles that share a side meets both. The first triangle is taken.
  struct Crossing {
    std::size_t triangle = 0;
    Vec3 at = Vec3::Zero();
    bool a_above = false;
  };
  [[nodiscard]] std::optional<Crossing> crossing(const Vec3& a, const Vec3& b) const;

  /// The triangle that says on which side a point is: the nearest, and of those equally near the one that sees the
  /// point most from above or below (where two triangles meet at an angle, the other one may see it from the side).
  [[nodiscard]] const CutTriangle& facing(const Vec3& at) const;
  /// Height above the facing triangle.
  [[nodiscard]] double height(const Vec3& at) const { return facing(at).height(at); }
  /// On the swept surface itself, not only on a plane of it.
  [[nodiscard]] bool is_on(const Vec3& at) const;

 private:
  struct Earlier;
  void add(const std::array<Vec3, 3>& corner);
  [[nodiscard]] Earlier earlier(std::span<const mesh::MeshEdit> history, double mean_edge) const;

  std::vector<CutTriangle> triangles_;
  double on_plane_ = 0.0;
};

}  // namespace rhexis::fracture
