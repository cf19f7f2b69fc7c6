#pragma once

/// The point that the hand holds, and the force it feels there (section 2.1 of the method; (3.30)-(3.33) of the
/// thesis).

#include <array>
#include <cstddef>
#include <optional>

#include <Eigen/Core>

#include "base/vec.h"
#include "mesh/torn_mesh.h"

namespace rhexis::response {

/// How the force of a point inside a surface triangle comes about. consistent: one constraint u(q) = sum A_i u_i, so
/// f = (N L N^T)^-1 d. blend: the thesis's rule, each vertex displaced alone by d, reactions blended with the area
/// coordinates: f = sum A_i (L_ii)^-1 d. At a vertex the two agree.
enum class ContactRule { consistent, blend };
/// hold: the point follows the hand. push: only where the hand presses against the outward normal, without friction.
enum class ContactMode { hold, push };

/// A point of the surface. Nodes with weight zero are left out, so that a held vertex has one.
struct SurfacePoint {
  std::array<NodeId, 3> node;    ///< the first `count` are meant
  Vec3 weight = Vec3::Zero();    ///< area coordinates, sum 1
  int count = 0;                 ///< 1 to 3
  Vec3 position = Vec3::Zero();  ///< reference, m
  Vec3 normal = Vec3::UnitZ();   ///< outward, unit
};

/// The surface point of the body's present topology that is nearest to `at` (m), a vertex where it lies within
/// `snap` (m) of one; empty for a body without tets in the solve. Faces of frozen pieces do not count.
[[nodiscard]] std::optional<SurfacePoint> nearest_surface_point(const mesh::TornMesh& body, const Vec3& at,
                                                                double snap = 0.0);

/// The linear map from the hand's displacement to forces, for one topology: what a tick evaluates, of fixed size.
struct ContactLaw {
  ContactMode mode = ContactMode::hold;
  Vec3 normal = Vec3::UnitZ();
  Vec3 rest = Vec3::Zero();       ///< displacement of the point by the loads alone, m: forces start from there
  Mat3 stiffness = Mat3::Zero();  ///< N/m: force on the body for a displacement beyond `rest`
  Eigen::Matrix<double, 9, 3> spread =
      Eigen::Matrix<double, 9, 3>::Zero();  ///< N/m: the same as forces on the three nodes

  /// Force of the hand on the body for its displacement (m) from the reference position, N; the hand feels the
  /// opposite.
  [[nodiscard]] Vec3 force(const Vec3& hand) const;
  /// The nodal forces that go with it, N, 3 per node.
  [[nodiscard]] Eigen::Matrix<double, 9, 1> nodal_forces(const Vec3& hand) const;
};

/// `compliance`: L_cc of the point's nodes, m/N, 3 count squared, symmetric positive definite; `rest`: displacement of
/// those nodes by the loads, m, 3 count.
[[nodiscard]] ContactLaw make_contact_law(const SurfacePoint& point, ContactRule rule, ContactMode mode,
                                          const Eigen::MatrixXd& compliance, const VectorX& rest);

}  // namespace rhexis::response
