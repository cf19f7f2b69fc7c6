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
  std::int32_t dof = 0;  ///< 3 * node + component, of the displacement space
  double value = 0.0;    ///< m at t = 1
};

/// Pressure p on the deformed surface: force -p n da, p > 0 pushes against the outward normal. Triangles in the order
/// of their outward normal; P2: 3 vertices, then the middles of the edges 01, 12, 20.
struct FollowerPressure {
  double pressure = 0.0;                ///< Pa at t = 1
  std::vector<std::int32_t> triangles;  ///< nodes of the displacement space, 3 (P1) or 6 (P2) each
  int nodes_per_triangle = 3;
  /// The load stiffness is symmetric where unknowns are free: every rim edge (an edge that one triangle has) is held,
  /// that is all three components of its ends and middle are prescribed, or there is no rim.
  bool closed_or_held_rim = false;
};

struct Loading {
  std::vector<PrescribedDof> supports;  ///< ascending by dof, no dof twice
  VectorX dead_force;                   ///< N at t = 1, length dof_count(); body force and tractions, consistent
  std::vector<FollowerPressure> pressures;
};

/// Of the displacement space: all that no support gives.
[[nodiscard]] linalg::FreeDofs free_dofs(const DisplacementSpace& space, const Loading& loading);

/// force += consistent nodal forces of a body force per reference volume (N/m^3; rho0 g). P1: V/4 per node; P2: -V/20
/// per vertex and V/5 per edge, which is the exact integral.
void add_body_force(const mesh::TetMesh& mesh, const DisplacementSpace& space, const Vec3& force_density,
                    VectorX& force);

/// force += a total force (N) spread evenly over the reference area of the faces, of which there must be some. P1: a
/// third of each face's share per vertex; P2: a third per edge, nothing at the vertices, which is the exact integral.
void add_traction(const mesh::TetMesh& mesh, const DisplacementSpace& space, const std::vector<mesh::TetFace>& faces,
                  const Vec3& total_force, VectorX& force);

/// `supports` decide whether the rim is held.
[[nodiscard]] FollowerPressure make_follower_pressure(const mesh::TetMesh& mesh, const DisplacementSpace& space,
                                                      const std::vector<mesh::TetFace>& faces, double pressure,
                                                      const std::vector<PrescribedDof>& supports);

/// force += t * (nodal force of the pressure at displacement u), N. Exact: the integrand is a polynomial of degree 4.
void add_pressure_force(const FollowerPressure& load, const DisplacementSpace& space, const VectorX& u, double t,
                        VectorX& force);

/// K -= t * d(force)/du. A surface with a free rim has a skew part, which goes to K.skew (made if there is none). With
/// a closed surface or a held rim the skew parts of the triangles cancel wherever an unknown is free, and are dropped.
void subtract_pressure_stiffness(const FollowerPressure& load, const DisplacementSpace& space, const VectorX& u,
                                 double t, linalg::SaddleMatrix& K);

/// force = t (dead forces + follower pressures at displacement u), N.
void external_force(const Loading& loading, const DisplacementSpace& space, const VectorX& u, double t, VectorX& force);

/// K -= t * d(all follower pressures)/du; K.skew is theirs alone.
void subtract_load_stiffness(const Loading& loading, const DisplacementSpace& space, const VectorX& u, double t,
                             linalg::SaddleMatrix& K);

}  // namespace rhexis::model
