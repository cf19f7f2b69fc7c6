#pragma once

/// The dense work of a front. Compiled for several instruction sets, chosen once at run time.
///
/// Not BLAS: fronts are factored on several threads at once, and Debian's OpenBLAS for programs without threads of
/// BLAS's own hands the same work space to two callers (one run in fifty went wrong). Eigen's kernels share nothing,
/// and with AVX-512 they are as fast: 80 GFlop/s where a core of 2.6 GHz could do 83.

#include <string_view>

namespace rhexis::linalg {

/// Matrices by columns; `ld` is the distance from a column to the next.
struct FrontKernels {
  /// Cholesky of the lower triangle of A, columns squared, in place. Nothing above the diagonal has a meaning, before
  /// or after. `inverse`: kFactorWidth x columns rounded up to its multiple, L^-T of each narrow block of the diagonal
  /// beside one another, for solve_rows. `work`: as there, for `columns` rows. False: a pivot is not positive, or not a
  /// number.
  bool (*factor)(double* A, int columns, int ld, double* inverse, double* work);
  /// B = B L^-T; B rows x columns, with the same ld as L. `work`: rows x kFactorWidth.
  void (*solve_rows)(double* B, int rows, const double* L, const double* inverse, int columns, int ld, double* work);
  /// C -= A B^T on and below the diagonal, where B is the first `columns` rows of A: C rows x columns, A rows x depth.
  void (*subtract_lower)(double* C, int ldc, const double* A, int ld, int rows, int columns, int depth);
  /// r over the pivots and the boundary below them: r_p = L_pp^-1 r_p, then r_b -= L_bp r_p.
  void (*forward)(const double* L, int ld, int pivots, int boundary, double* r, int ldr, int columns);
  /// x_p = L_pp^-T (x_p - L_bp^T x_b); x over the pivots and the boundary below them.
  void (*backward)(const double* L, int ld, int pivots, int boundary, double* x);
  /// W = [L_pp^-1; L_bp L_pp^-1] in single precision, (pivots + boundary) x pivots with distance ldw, of L with ld.
  void (*invert_panel)(const double* L, int ld, int pivots, int boundary, float* W, int ldw);
  /// Y = W X for 1, 2 or 4 columns of X and Y, which are ldx and ldy from one another; W rows x columns. `rows` and
  /// all distances are multiples of kSinglePacket.
  void (*multiply_single)(const float* W, int ld, int rows, int columns, int lanes, const float* X, int ldx, float* Y,
                          int ldy);
  /// Y = W^T X likewise; W rows x columns.
  void (*multiply_transposed_single)(const float* W, int ld, int rows, int columns, int lanes, const float* X, int ldx,
                                     float* Y, int ldy);
  /// to += from.
  void (*add)(double* to, const double* from, int count);
};

inline constexpr int kFactorWidth = 32;
/// Single precision numbers in the widest vector of all instruction sets.
inline constexpr int kSinglePacket = 16;

/// "portable", "avx2" or "avx512"; nullptr where the processor or the build has none.
[[nodiscard]] const FrontKernels* find_front_kernels(std::string_view name);
/// The widest that the processor has, or what the environment variable RHEXIS_SIMD names.
[[nodiscard]] const FrontKernels& front_kernels();

namespace portable {
FrontKernels make_front_kernels();
}
namespace avx2 {
FrontKernels make_front_kernels();
}
namespace avx512 {
FrontKernels make_front_kernels();
}

}  // namespace rhexis::linalg
