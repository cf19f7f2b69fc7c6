#pragma once

/// The isochoric part of Mooney-Rivlin: W = c1 (I1 J^(-2/3) - 3) + c2 (I2 J^(-4/3) - 3), equation (1) of the paper.

#include "material/tensor.h"

namespace rhexis::material {

struct MooneyRivlinLaw {
  double c1 = 0.0;  ///< Pa
  double c2 = 0.0;  ///< Pa

  static constexpr bool kIsochoric = true;

  /// Energy per reference volume, J/m^3.
  template <class T>
  RHEXIS_INLINE T energy(const Deformation<T>& d) const {
    const T r = inverse_cbrt(d.J);
    const T a = r * r;
    return c1 * (trace(d.C) * a - 3.0) + c2 * (second_invariant(d.C) * (a * a) - 3.0);
  }

  /// Second Piola-Kirchhoff stress S = 2 dW/dC, Pa.
  template <class T>
  RHEXIS_INLINE Sym<T> stress(const Deformation<T>& d) const {
    const T r = inverse_cbrt(d.J);
    const T a = r * r;
    const T a1 = 2.0 * c1 * a;
    const T a2 = 2.0 * c2 * (a * a);
    const T I1 = trace(d.C);
    // dI1/dC = I, dI2/dC = I1 I - C, dJ/dC = J C^-1 / 2.
    const T unit = a1 + a2 * I1;
    const T volume = (-1.0 / 3.0) * (a1 * I1 + 2.0 * a2 * second_invariant(d.C));
    const Sym<T>&C = d.C, &K = d.Cinv;
    return {unit - a2 * C.xx + volume * K.xx, unit - a2 * C.yy + volume * K.yy, unit - a2 * C.zz + volume * K.zz,
            volume * K.xy - a2 * C.xy,        volume * K.yz - a2 * C.yz,        volume * K.xz - a2 * C.xz};
  }

  /// D = dS/dE = 2 dS/dC, Pa.
  template <class T>
  RHEXIS_INLINE Sym66<T> tangent(const Deformation<T>& d) const {
    const T r = inverse_cbrt(d.J);
    const T a = r * r;
    const T b1 = 4.0 * c1 * a;
    const T b2 = 4.0 * c2 * (a * a);
    const T I1 = trace(d.C), I2 = second_invariant(d.C);
    // With T = I1 I - C, K = C^-1:
    //   D = b1 (-(I (x) K + K (x) I) / 3 + I1/9 K (x) K + I1/3 K . K)
    //     + b2 (I (x) I - II - 2/3 (T (x) K + K (x) T) + 4/9 I2 K (x) K + 2/3 I2 K . K)
    const T unit = (-1.0 / 3.0) * (b1 + 2.0 * b2 * I1);
    const T own = (2.0 / 3.0) * b2;
    const T half_square = (1.0 / 18.0) * (b1 * I1 + 4.0 * b2 * I2);
    const Sym<T>&C = d.C, &K = d.Cinv;
    const Sym<T> p{unit + own * C.xx + half_square * K.xx, unit + own * C.yy + half_square * K.yy,
                   unit + own * C.zz + half_square * K.zz, own * C.xy + half_square * K.xy,
                   own * C.yz + half_square * K.yz,        own * C.xz + half_square * K.xz};
    Sym66<T> D = zero_tangent<T>();
    add_isotropic(b2, T(-1.0 * b2), D);
    add_symmetric_product(p, K, D);
    add_square_product(T((1.0 / 3.0) * (b1 * I1 + 2.0 * b2 * I2)), K, D);
    return D;
  }
};

}  // namespace rhexis::material
