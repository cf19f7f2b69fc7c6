#pragma once

/// The energy release of a front from the fields around it: the J-integral in its domain form (Li, Shih, Needleman
/// 1985; Shih, Moran, Nakamura 1986), which does not read the nodes next to the tip. Small strain, linear.
///   G = integral of (sigma_ij u_j,k d_k - W d_i) q,i - b_j u_j,k d_k q  /  integral of q along the front,
/// d the present direction, q 1 around the front and falling to 0: straight extension.

#include <span>
#include <vector>

#include "fracture/crack.h"
#include "material/parameters.h"
#include "mesh/torn_mesh.h"

namespace rhexis::fracture {

/// q is 1 up to `inner` and 0 from `outer` on, m, by distance from the front across its tangent.
struct EnergyDomain {
  double inner = 0.0;
  double outer = 0.0;
};
/// In mean edges: what a local object of four mean edges holds whole.
inline constexpr double kInnerEdges = 1.0;
inline constexpr double kOuterEdges = 3.0;

/// N/m, one per front_sections() of the crack: a plate's line as a whole, else per point, with q falling to 0 along the
/// front two points further on. `tets` and `gradients` (grad u) as of a local object that holds every tet with a corner
/// within `outer` of the front. `body_force` N/m^3.
[[nodiscard]] std::vector<double> energy_release(const mesh::TornMesh& body, const material::Elastic& elastic,
                                                 const Crack& crack, std::span<const TetId> tets,
                                                 std::span<const Mat3> gradients, const EnergyDomain& domain,
                                                 const Vec3& body_force = Vec3::Zero());

/// K_I = sqrt(G E'), Pa m^0.5, E' = E / (1 - nu^2): plane strain, as it is inside a body; 0 for G <= 0.
[[nodiscard]] double stress_intensity(const material::Elastic& elastic, double energy_release);

}  // namespace rhexis::fracture
