#pragma once

/// Symmetric tensors for laws and kernels, templated on the scalar: double, a pack of doubles, or a dual number in
/// tests. Component order everywhere: xx yy zz xy yz xz.
///
/// The kernels compile this code for several instruction sets within one program, so every function must be inlined
/// away (RHEXIS_INLINE) and be a template on the scalar: nothing compiled for AVX may be shared with the baseline.

#include <cmath>

#define RHEXIS_INLINE __attribute__((always_inline)) inline
/// Before a loop of constant length whose body must be straight code.
#if defined(__clang__)
#define RHEXIS_UNROLL _Pragma("clang loop unroll(full)")
#else
#define RHEXIS_UNROLL _Pragma("GCC unroll 32")
#endif

namespace rhexis::material {

/// Tensor components; shear is not doubled.
template <class T>
struct Sym {
  T xx, yy, zz, xy, yz, xz;
};

/// Symmetric 6 x 6: D(I, J) = dS_I / dE_J, so that dS_I = sum_J D(I, J) e_J with the engineering strains
/// e = (dE_xx, dE_yy, dE_zz, 2 dE_xy, 2 dE_yz, 2 dE_xz). Lower triangle by rows.
template <class T>
struct Sym66 {
  T packed[21];

  RHEXIS_INLINE T& operator()(int row, int col) { return packed[row >= col ? place(row, col) : place(col, row)]; }
  RHEXIS_INLINE const T& operator()(int row, int col) const {
    return packed[row >= col ? place(row, col) : place(col, row)];
  }

 private:
  RHEXIS_INLINE static constexpr int place(int row, int col) { return row * (row + 1) / 2 + col; }
};

/// What a law sees of the deformation; frame indifferent by construction.
template <class T>
struct Deformation {
  Sym<T> C;     ///< F^T F
  Sym<T> Cinv;  ///< C^-1
  T J;          ///< det F
};

template <class T>
RHEXIS_INLINE T trace(const Sym<T>& a) {
  return a.xx + a.yy + a.zz;
}

/// a : b.
template <class T>
RHEXIS_INLINE T contract(const Sym<T>& a, const Sym<T>& b) {
  return a.xx * b.xx + a.yy * b.yy + a.zz * b.zz + 2.0 * (a.xy * b.xy + a.yz * b.yz + a.xz * b.xz);
}

/// I2 = (I1^2 - tr a^2) / 2, as the sum of the principal minors.
template <class T>
RHEXIS_INLINE T second_invariant(const Sym<T>& a) {
  return (a.xx * a.yy - a.xy * a.xy) + (a.yy * a.zz - a.yz * a.yz) + (a.xx * a.zz - a.xz * a.xz);
}

/// Cofactors of a symmetric tensor: det(a) a^-1.
template <class T>
RHEXIS_INLINE Sym<T> adjugate(const Sym<T>& a) {
  return {a.yy * a.zz - a.yz * a.yz, a.xx * a.zz - a.xz * a.xz, a.xx * a.yy - a.xy * a.xy,
          a.xz * a.yz - a.xy * a.zz, a.xy * a.xz - a.xx * a.yz, a.xy * a.yz - a.xz * a.yy};
}

template <class T>
RHEXIS_INLINE Sym<T> scaled(const Sym<T>& a, const T& s) {
  return {a.xx * s, a.yy * s, a.zz * s, a.xy * s, a.yz * s, a.xz * s};
}

/// a + s b.
template <class T>
RHEXIS_INLINE Sym<T> plus_scaled(const Sym<T>& a, const T& s, const Sym<T>& b) {
  return {a.xx + s * b.xx, a.yy + s * b.yy, a.zz + s * b.zz, a.xy + s * b.xy, a.yz + s * b.yz, a.xz + s * b.xz};
}

/// `F` row-major, `J` its determinant.
template <class T>
RHEXIS_INLINE Deformation<T> deformation_of(const T (&F)[9], const T& J) {
  const Sym<T> C{F[0] * F[0] + F[3] * F[3] + F[6] * F[6], F[1] * F[1] + F[4] * F[4] + F[7] * F[7],
                 F[2] * F[2] + F[5] * F[5] + F[8] * F[8], F[0] * F[1] + F[3] * F[4] + F[6] * F[7],
                 F[1] * F[2] + F[4] * F[5] + F[7] * F[8], F[0] * F[2] + F[3] * F[5] + F[6] * F[8]};
  const T inverse_det = 1.0 / (J * J);
  return {C, scaled(adjugate(C), inverse_det), J};
}

/// D += a (x) b + b (x) a.
template <class T>
RHEXIS_INLINE void add_symmetric_product(const Sym<T>& a, const Sym<T>& b, Sym66<T>& D) {
  const T p[6] = {a.xx, a.yy, a.zz, a.xy, a.yz, a.xz};
  const T q[6] = {b.xx, b.yy, b.zz, b.xy, b.yz, b.xz};
  RHEXIS_UNROLL
  for (int i = 0; i < 6; ++i) {
    RHEXIS_UNROLL
    for (int j = 0; j < 6; ++j) {
      if (j <= i) D(i, j) = D(i, j) + (p[i] * q[j] + q[i] * p[j]);
    }
  }
}

/// D += s K . K, where (K . K)_ijkl = (K_ik K_jl + K_il K_jk) / 2; -dK/dC for K = C^-1.
template <class T>
RHEXIS_INLINE void add_square_product(const T& s, const Sym<T>& K, Sym66<T>& D) {
  const T h = 0.5 * s;
  const Sym<T> H = scaled(K, h);  // entries of both kinds carry the half
  D(0, 0) = D(0, 0) + 2.0 * H.xx * K.xx;
  D(1, 0) = D(1, 0) + 2.0 * H.xy * K.xy;
  D(1, 1) = D(1, 1) + 2.0 * H.yy * K.yy;
  D(2, 0) = D(2, 0) + 2.0 * H.xz * K.xz;
  D(2, 1) = D(2, 1) + 2.0 * H.yz * K.yz;
  D(2, 2) = D(2, 2) + 2.0 * H.zz * K.zz;
  D(3, 0) = D(3, 0) + 2.0 * H.xx * K.xy;
  D(3, 1) = D(3, 1) + 2.0 * H.xy * K.yy;
  D(3, 2) = D(3, 2) + 2.0 * H.xz * K.yz;
  D(3, 3) = D(3, 3) + (H.xx * K.yy + H.xy * K.xy);
  D(4, 0) = D(4, 0) + 2.0 * H.xy * K.xz;
  D(4, 1) = D(4, 1) + 2.0 * H.yy * K.yz;
  D(4, 2) = D(4, 2) + 2.0 * H.yz * K.zz;
  D(4, 3) = D(4, 3) + (H.xy * K.yz + H.xz * K.yy);
  D(4, 4) = D(4, 4) + (H.yy * K.zz + H.yz * K.yz);
  D(5, 0) = D(5, 0) + 2.0 * H.xx * K.xz;
  D(5, 1) = D(5, 1) + 2.0 * H.xy * K.yz;
  D(5, 2) = D(5, 2) + 2.0 * H.xz * K.zz;
  D(5, 3) = D(5, 3) + (H.xx * K.yz + H.xz * K.xy);
  D(5, 4) = D(5, 4) + (H.xy * K.zz + H.xz * K.yz);
  D(5, 5) = D(5, 5) + (H.xx * K.zz + H.xz * K.xz);
}

/// D += s (I (x) I) + t II, II the identity on symmetric tensors.
template <class T>
RHEXIS_INLINE void add_isotropic(const T& s, const T& t, Sym66<T>& D) {
  RHEXIS_UNROLL
  for (int i = 0; i < 3; ++i) {
    RHEXIS_UNROLL
    for (int j = 0; j < 3; ++j) {
      if (j <= i) D(i, j) = D(i, j) + s;
    }
    D(i, i) = D(i, i) + t;
    D(i + 3, i + 3) = D(i + 3, i + 3) + 0.5 * t;
  }
}

template <class T>
RHEXIS_INLINE Sym66<T> zero_tangent() {
  Sym66<T> D;
  RHEXIS_UNROLL
  for (int i = 0; i < 21; ++i) D.packed[i] = T(0.0);
  return D;
}

/// x^(-1/3), x > 0. Packs and dual numbers bring their own, found by their namespace.
inline double inverse_cbrt(double x) { return 1.0 / std::cbrt(x); }

}  // namespace rhexis::material
