#pragma once

/// What acts on the body: supports, dead loads and follower pressures, all scaled by one load fraction t in [0, 1].

#include <cstdint>
#include <vector>

#include "base/vec.h"
#include "linalg/saddle_matrix.h"
#include "mesh/tet_mesh.h"
#include "model/space.h"

namespace rhexis::model {

/// u[dof] = t * value.
struct PrescribedDof {
  std::int32_t dof = 0;   ///< 3 * node + component, of the displacement space
  double value = 0.0;     ///< m at t = 1
};

/// Pressure p on the deformed surface: force -p n da, p > 0 pushes against the outward normal. Triangles in the order
/// of their outward normal; P2: 3 vertices, then the middles of the edges 01, 12, 20.
struct FollowerPressure {
  double pressure = 0.0;                    ///< Pa at t = 1
  std::vector<std::int32_t> triangles;      ///< nodes of the displacement space, 3 (P1) or 6 (P2) each
  int nodes_per_triangle = 3;
  bool closed_or_held_rim = false;          ///< the load stiffness is symmetric: every rim edge has both ends held, or none exists
};

struct Loading {
  std::vector<PrescribedDof> supports;      ///< ascending by dof, no dof twice
  VectorX dead_force;                       ///< N at t = 1, length dof_count(); body force and tractions, consistent
  std::vector<FollowerPressure> pressures;
};

/// Consistent nodal forces of a body force per reference volume (N/m^3; rho0 g): rho V / 4 per node for P1.
void add_body_force(const mesh::TetMesh& mesh, const DisplacementSpace& space, const Vec3& force_density, VectorX& force);
/// Of a total force (N) spread evenly over the reference area of the faces.
void add_traction(const mesh::TetMesh& mesh, const DisplacementSpace& space, const std::vector<mesh::TetFace>& faces,
                  const Vec3& total_force, VectorX& force);
[[nodiscard]] FollowerPressure make_follower_pressure(const mesh::TetMesh& mesh, const DisplacementSpace& space,
                                                      const std::vector<mesh::TetFace>& faces, double pressure,
                                                      const std::vector<PrescribedDof>& supports);

/// force += t * (nodal force of the pressure at displacement u), N.
void add_pressure_force(const FollowerPressure& load, const DisplacementSpace& space, const VectorX& u, double t, VectorX& force);
/// K -= t * d(force)/du; the skew part goes to K.skew when the surface has a free rim, and is dropped (it vanishes in the sum)
/// otherwise.
void subtract_pressure_stiffness(const FollowerPressure& load, const DisplacementSpace& space, const VectorX& u, double t,
                                 linalg::SaddleMatrix& K);

}  // namespace rhexis::model
