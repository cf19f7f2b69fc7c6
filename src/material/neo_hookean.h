#pragma once

/// The isochoric part of neo-Hookean: W = c1 (I1 J^(-2/3) - 3). Mooney-Rivlin with c2 = 0, at less cost.

#include "material/tensor.h"

namespace rhexis::material {

struct NeoHookeanLaw {
  double c1 = 0.0;  ///< Pa, half the shear modulus

  static constexpr bool kIsochoric = true;

  /// Energy per reference volume, J/m^3.
  template <class T>
  RHEXIS_INLINE T energy(const Deformation<T>& d) const {
    const T r = inverse_cbrt(d.J);
    return c1 * (trace(d.C) * (r * r) - 3.0);
  }

  /// Second Piola-Kirchhoff stress S = 2 dW/dC, Pa.
  template <class T>
  RHEXIS_INLINE Sym<T> stress(const Deformation<T>& d) const {
    const T r = inverse_cbrt(d.J);
    const T unit = 2.0 * c1 * (r * r);
    const T volume = (-1.0 / 3.0) * unit * trace(d.C);
    const Sym<T>& K = d.Cinv;
    return {unit + volume * K.xx, unit + volume * K.yy, unit + volume * K.zz,
            volume * K.xy,        volume * K.yz,        volume * K.xz};
  }

  /// D = dS/dE = 2 dS/dC, Pa.
  template <class T>
  RHEXIS_INLINE Sym66<T> tangent(const Deformation<T>& d) const {
    const T r = inverse_cbrt(d.J);
    const T b = 4.0 * c1 * (r * r);
    const T unit = (-1.0 / 3.0) * b;
    const T half_square = (1.0 / 18.0) * b * trace(d.C);
    const Sym<T>& K = d.Cinv;
    const Sym<T> p{unit + half_square * K.xx, unit + half_square * K.yy, unit + half_square * K.zz,
                   half_square * K.xy,        half_square * K.yz,        half_square * K.xz};
    Sym66<T> D = zero_tangent<T>();
    add_symmetric_product(p, K, D);
    add_square_product(T((1.0 / 3.0) * b * trace(d.C)), K, D);
    return D;
  }
};

}  // namespace rhexis::material
