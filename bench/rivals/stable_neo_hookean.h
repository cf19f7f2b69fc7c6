#pragma once

/// The law of Bullet's btDeformableNeoHookeanForce ("stable neo-Hookean", Smith, de Goes, Kim 2018), solved slowly and
/// by itself: the converged answer that Bullet's frames are held against. With I = tr F^T F, J = det F:
///
///     W = mu/2 (I - 3) - mu/2 log(I + 1) + lambda/2 (J - 1 - 3 mu / (4 lambda))^2 + const
///     P = mu (1 - 1 / (I + 1)) F + (lambda (J - 1) - 3/4 mu) cof F.

#include <Eigen/SparseCore>

#include "base/vec.h"
#include "bench/rivals/bar.h"

namespace rhexis::rivals {

/// Of the law with which E and nu of `elastic` are those at rest: mu = 4/3 mu_0, lambda = lambda_0 + 5/6 mu_0.
struct StableNeoHookean {
  explicit StableNeoHookean(const material::Elastic& elastic)
      : mu(4.0 / 3.0 * elastic.lame_mu()), lambda(elastic.lame_lambda() + 5.0 / 6.0 * elastic.lame_mu()) {}
  double mu;      ///< Pa
  double lambda;  ///< Pa

  [[nodiscard]] double energy(const Mat3& F) const;                 ///< J/m^3
  [[nodiscard]] Mat3 stress(const Mat3& F) const;                   ///< P = dW/dF, Pa
  [[nodiscard]] Mat3 tangent(const Mat3& F, const Mat3& dF) const;  ///< dP, Pa
};

/// Nodal forces of the body at `u`, dW/du, N.
[[nodiscard]] VectorX internal_force(const Bar& bar, const StableNeoHookean& law, const VectorX& u);

/// The equilibrium with the hand at `hand` from a displacement near it, by Newton with a direct solver: the residual
/// below 1e-9 of the forces, or RHEXIS_CHECK.
[[nodiscard]] VectorX converged(const Bar& bar, const StableNeoHookean& law, const Vec3& hand, VectorX near);

/// Largest relative difference of P from the energy's finite differences, and of dP from P's, at some F.
[[nodiscard]] double derivative_error(const StableNeoHookean& law);

}  // namespace rhexis::rivals
