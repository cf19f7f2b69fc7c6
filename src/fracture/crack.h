#pragma once

/// Where a crack has got to: its front, a polyline across the body. On a plate that is a line along z, of two points
/// that share one direction; on any other body each point has its own (section 2.3 of the method).

#include <Eigen/Geometry>

#include <vector>

#include "base/vec.h"

namespace rhexis::fracture {

struct FrontPoint {
  Vec3 position = Vec3::Zero();    ///< reference, m
  Vec3 direction = Vec3::UnitX();  ///< unit: where the crack runs at present; normal to `tangent`
  Vec3 tangent = Vec3::UnitZ();    ///< unit: along the front, towards the next point
  /// Unit normal of the crack plane. The side it points to is the upper flank.
  [[nodiscard]] Vec3 normal() const { return tangent.cross(direction); }
};

struct Crack {
  std::vector<FrontPoint>
      front;             ///< at least two, in order along the front; the first and last are on the surface or beyond it
  bool uniform = false;  ///< a plate: one direction and one length for all points
  bool finished = false;  ///< the front has left the body or run into another crack: nothing is ahead of it
  double area = 0.0;      ///< m^2, of the surface swept so far, once (not both flanks)
};

/// The surface that an advance sweeps, as triangles; what lies on the side of their normals is above. It reaches a
/// little beyond the body where the front ends on its surface, so that every edge there is met.
struct CutSurface {
  struct Triangle {
    Vec3 a, b,
        c;  ///< m; normal (b - a) x (c - a); `a` is on the front before, `c` on the one after, if there are fronts
  };
  std::vector<Triangle> triangles;
};

}  // namespace rhexis::fracture
