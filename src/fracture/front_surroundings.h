#pragma once

/// Where the body is, as a front has to know it: a grid over the intact mesh. It answers which tets are near a front,
/// in time that does not grow with the body, and where a line is inside the body, gaps of removed tets included: a
/// front stands in the gap that its own incision left.

#include <array>
#include <cstdint>
#include <vector>

#include "fracture/crack.h"
#include "mesh/mesh_edit.h"
#include "mesh/torn_mesh.h"

namespace rhexis::fracture {

class Surroundings {
 public:
  /// `intact`: before any edit, without defects. O(n); keeps its own copy of the shape.
  explicit Surroundings(const mesh::TetMesh& intact);

  [[nodiscard]] double mean_edge() const { return mean_edge_; }  ///< m, over distinct edges
  /// Thin and extruded along z: every surface triangle is level or upright, and the height is at most a quarter of the
  /// smaller side. Cracks of such a body are uniform.
  [[nodiscard]] bool is_plate() const { return plate_; }
  [[nodiscard]] const mesh::BoundingBox& box() const { return box_; }

  /// After the body has taken an edit. Not needed when it gives one back.
  void follow(const mesh::MeshEdit& edit, const mesh::TornMesh& body);

  /// Tets in the solve whose centroid is within `radius` (m) of the front's polyline, ascending.
  [[nodiscard]] std::vector<TetId> tets_near(const mesh::TornMesh& body, const Crack& crack, double radius) const;
  /// Tets in the solve whose own box meets the box from..to (m), as they are now; ascending.
  [[nodiscard]] std::vector<TetId> tets_meeting(const mesh::TornMesh& body, const Vec3& from, const Vec3& to) const;

  struct Interval {
    double from = 0.0;  ///< part of the way, 0 to 1
    double to = 0.0;
  };
  /// The parts of the way from `a` to `b` (m) that lie in the intact body, in order, apart from each other.
  [[nodiscard]] std::vector<Interval> inside(const Vec3& a, const Vec3& b) const;
  [[nodiscard]] bool is_inside(const Vec3& at) const;
  /// The point of the intact surface nearest to `at`, m.
  [[nodiscard]] Vec3 nearest_on_surface(const Vec3& at) const;

 private:
  struct Triangle {
    std::array<Vec3, 3> corner;
  };
  template <class Use>
  void visit(const Vec3& from, const Vec3& to, Use&& use) const;

  std::vector<Vec3> nodes_;
  std::vector<mesh::Tet> tets_;
  std::vector<Triangle> surface_;
  mesh::BoundingBox box_;
  double mean_edge_ = 0.0;
  bool plate_ = false;
  double drift_ = 0.0;  ///< m: no centroid has gone further than this from where the grid has it
  double reach_ = 0.0;  ///< m: no corner is further than this from its tet's centroid
  double cell_ = 0.0;   ///< m
  std::array<int, 3> cells_{1, 1, 1};
  std::vector<std::int32_t> cell_start_;
  std::vector<std::int32_t> cell_tets_;
};

}  // namespace rhexis::fracture
