#pragma once

/// The energy release of a front from the fields around it: the J-integral in its domain form (Li, Shih, Needleman
/// 1985; Shih, Moran, Nakamura 1986), which does not read the nodes next to the tip. It is the flux of Eshelby's tensor
/// W I - (grad u)^T P in the reference configuration, where the crack runs,
///   G = integral of (P_iJ u_i,K d_K - W d_J) q,J - b_i u_i,K d_K q  /  integral of q along the front,
/// d the present direction, q 1 around the front and falling to 0: straight extension. W is the stored energy and
/// P = dW/dF the first Piola-Kirchhoff stress of the model that the body has: of small strains sigma : eps / 2 and
/// sigma. F^T P in place of (grad u)^T P, which differs by d . (P grad q - b q), is the same in equilibrium.
///
/// Of the pressure-stabilised mixed model (`hyperelastic`) they are those of its Lagrangian
///   L(u, lambda) = sum over tets of V W - lambda . K_S lambda / 2,  W = W_iso(F) + lambda (J - 1) - lambda^2 / 2
///   kappa,
/// P = dW_iso/dF + lambda J F^-T: where L is stationary in u and lambda, dL/da is its derivative at fixed u and lambda
/// by the places of the nodes, moved by q d, and that of V W is the integral above. Of the jump terms K_S the
/// derivative is left out: it vanishes with h^2 as they do, being none of the material.

#include <span>
#include <vector>

#include "base/ids.h"
#include "base/vec.h"
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

/// A tet of the integral.
struct EnergyTet {
  TetId tet;
  Mat3 gradient = Mat3::Zero();  ///< grad u = F - I
  Mat3 P = Mat3::Zero();         ///< first Piola-Kirchhoff stress, Pa
  double W = 0.0;                ///< stored energy per reference volume, J/m^3
};
/// Of small strains. `gradients`: grad u, per tet.
[[nodiscard]] std::vector<EnergyTet> small_strain_energies(const material::Elastic& elastic,
                                                           std::span<const TetId> tets,
                                                           std::span<const Mat3> gradients);

/// N/m, one per front_sections() of the crack: a plate's line as a whole, else per point, with q falling to 0 along the
/// front two points further on. `tets`: as of a local object, every one with a corner within `outer` of the front.
/// `body_force` N/m^3 of the reference. Of a state out of equilibrium it is that of the state as it is, off by the
/// forces in the ring that are not balanced, times grad u d.
[[nodiscard]] std::vector<double> energy_release(const mesh::TornMesh& body, const Crack& crack,
                                                 std::span<const EnergyTet> tets, const EnergyDomain& domain,
                                                 const Vec3& body_force = Vec3::Zero());

/// K_I = sqrt(G E'), Pa m^0.5, E' = E / (1 - nu^2): small strains, and plane strain, as it is inside a body; 0 for
/// G <= 0.
[[nodiscard]] double stress_intensity(const material::Elastic& elastic, double energy_release);

}  // namespace rhexis::fracture
