#pragma once

/// St. Venant-Kirchhoff: S = lambda tr(E) I + 2 mu E with the Green-Lagrange strain E = (C - I) / 2; volume included.

#include "material/tensor.h"

namespace rhexis::material {

struct StVenantKirchhoffLaw {
  double lame_lambda = 0.0;  ///< Pa
  double lame_mu = 0.0;      ///< Pa

  static constexpr bool kIsochoric = false;

  /// Energy per reference volume, J/m^3.
  template <class T>
  RHEXIS_INLINE T energy(const Deformation<T>& d) const {
    const Sym<T> E = strain(d.C);
    const T tr = trace(E);
    return 0.5 * lame_lambda * tr * tr + lame_mu * contract(E, E);
  }

  /// Second Piola-Kirchhoff stress S = dW/dE, Pa.
  template <class T>
  RHEXIS_INLINE Sym<T> stress(const Deformation<T>& d) const {
    const Sym<T> E = strain(d.C);
    const T mean = lame_lambda * trace(E);
    const double two_mu = 2.0 * lame_mu;
    return {mean + two_mu * E.xx, mean + two_mu * E.yy, mean + two_mu * E.zz,
            two_mu * E.xy,        two_mu * E.yz,        two_mu * E.xz};
  }

  /// D = dS/dE, Pa; constant.
  template <class T>
  RHEXIS_INLINE Sym66<T> tangent(const Deformation<T>&) const {
    Sym66<T> D = zero_tangent<T>();
    add_isotropic(T(lame_lambda), T(2.0 * lame_mu), D);
    return D;
  }

 private:
  template <class T>
  RHEXIS_INLINE static Sym<T> strain(const Sym<T>& C) {
    return {0.5 * (C.xx - 1.0), 0.5 * (C.yy - 1.0), 0.5 * (C.zz - 1.0), 0.5 * C.xy, 0.5 * C.yz, 0.5 * C.xz};
  }
};

}  // namespace rhexis::material
