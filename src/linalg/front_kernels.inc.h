// The kernels of fronts for the instruction set that this unit is compiled for; RHEXIS_SIMD_NAMESPACE names it. Not a
// header: included once by each unit.
//
// Eigen is a library of templates, whose instances the linker merges by name, those for wider instructions with those
// for plainer processors. So each unit has an Eigen of its own name.

// gcc 12 takes the undefined upper half in its own AVX-512 intrinsics for a variable without a value.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#pragma GCC diagnostic ignored "-Wuninitialized"
#endif

// The loops over sums in registers have to be unrolled, or the sums lie in memory. Not by -O3 for the whole unit: the
// loops that gcc then peels until they are aligned round differently from address to address.
#if defined(__GNUC__) && !defined(__clang__)
#define RHEXIS_UNROLLED _Pragma("GCC unroll 32")
#else
#define RHEXIS_UNROLLED
#endif

#define RHEXIS_JOIN_NAMES(a, b) a##_##b
#define RHEXIS_JOIN(a, b) RHEXIS_JOIN_NAMES(a, b)
#define Eigen RHEXIS_JOIN(Eigen_fronts, RHEXIS_SIMD_NAMESPACE)
// Bytes of the copies that a product packs its factors into, up to which they lie on the stack. From malloc they would
// be fresh pages of the system in every product. No kernel calls anything that takes another such piece.
#define EIGEN_STACK_ALLOCATION_LIMIT (2 << 20)
#include <Eigen/Core>
#include <cmath>
#include <cstddef>

#include "linalg/front_kernels.h"

namespace rhexis::linalg::RHEXIS_SIMD_NAMESPACE {
namespace {

using Matrix = Eigen::Map<Eigen::MatrixXd, 0, Eigen::OuterStride<>>;
using ConstMatrix = Eigen::Map<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>;

void subtract_product(double* C, int ldc, const double* A, const double* B, int ld, int rows, int columns, int depth) {
  if (rows == 0 || columns == 0 || depth == 0) return;
  const ConstMatrix a(A, rows, depth, Eigen::OuterStride<>(ld));
  const ConstMatrix b(B, columns, depth, Eigen::OuterStride<>(ld));
  Matrix(C, rows, columns, Eigen::OuterStride<>(ldc)).noalias() -= a * b.transpose();
}

// Width of the strips that a product on and below a diagonal is cut into: what lies above in each is worked out in
// vain.
constexpr int kStrip = 2 * kFactorWidth;

void subtract_lower(double* C, int ldc, const double* A, int ld, int rows, int columns, int depth) {
  for (int j = 0; j < columns; j += kStrip) {
    const int count = columns - j < kStrip ? columns - j : kStrip;
    subtract_product(C + static_cast<std::ptrdiff_t>(j) * ldc + j, ldc, A + j, A + j, ld, columns - j, count, depth);
  }
  subtract_product(C + columns, ldc, A + columns, A, ld, rows - columns, columns, depth);
}

using Narrow = Eigen::Matrix<double, kFactorWidth, kFactorWidth>;

/// Columns of the left half, in whole narrow blocks.
int half_of(int columns) { return (columns / 2 + kFactorWidth - 1) / kFactorWidth * kFactorWidth; }

/// On copies of fixed size, whose columns are a few registers; unused rows and columns are those of the identity.
bool factor_narrow(double* A, int columns, int ld, double* inverse) {
  Matrix given(A, columns, columns, Eigen::OuterStride<>(ld));
  Narrow L = Narrow::Identity();
  for (int j = 0; j < columns; ++j) L.col(j).segment(j, columns - j) = given.col(j).segment(j, columns - j);
  Eigen::Map<Narrow> R(inverse);
  R.setIdentity();
  for (int j = 0; j < columns; ++j) {
    const double pivot = L(j, j);
    if (!(pivot > 0.0)) return false;  // nor is NaN
    const double scale = 1.0 / std::sqrt(pivot);
    L.col(j) *= scale;
    R.col(j) *= scale;
    for (int k = j + 1; k < columns; ++k) {
      const double factor = L(k, j);
      L.col(k) -= factor * L.col(j);
      R.col(k) -= factor * R.col(j);
    }
  }
  for (int j = 0; j < columns; ++j) given.col(j).segment(j, columns - j) = L.col(j).segment(j, columns - j);
  return true;
}

/// Left half, its effect on the right half, right half: all but narrow blocks is in products.
void solve_rows(double* B, int rows, const double* L, const double* inverse, int columns, int ld, double* work) {
  if (rows == 0) return;
  if (columns <= kFactorWidth) {
    const ConstMatrix R(inverse, columns, columns, Eigen::OuterStride<>(kFactorWidth));
    Matrix solved(B, rows, columns, Eigen::OuterStride<>(ld));
    Matrix copy(work, rows, columns, Eigen::OuterStride<>(rows));
    copy = solved;
    solved.noalias() = copy * R;
    return;
  }
  const int left = half_of(columns);
  const std::ptrdiff_t right = static_cast<std::ptrdiff_t>(left) * ld;
  solve_rows(B, rows, L, inverse, left, ld, work);
  subtract_product(B + right, ld, B, L + left, ld, rows, columns - left, left);
  solve_rows(B + right, rows, L + right + left, inverse + left * kFactorWidth, columns - left, ld, work);
}

bool factor(double* A, int columns, int ld, double* inverse, double* work) {
  if (columns <= kFactorWidth) return factor_narrow(A, columns, ld, inverse);
  const int left = half_of(columns);
  if (!factor(A, left, ld, inverse, work)) return false;
  solve_rows(A + left, columns - left, A, inverse, left, ld, work);
  double* const right = A + static_cast<std::ptrdiff_t>(left) * ld + left;
  subtract_lower(right, ld, A + left, ld, columns - left, columns - left, left);
  return factor(right, columns - left, ld, inverse + left * kFactorWidth, work);
}

void forward(const double* L, int ld, int pivots, int boundary, double* r, int ldr, int columns) {
  if (pivots == 0 || columns == 0) return;
  Matrix top(r, pivots, columns, Eigen::OuterStride<>(ldr));
  ConstMatrix(L, pivots, pivots, Eigen::OuterStride<>(ld)).triangularView<Eigen::Lower>().solveInPlace(top);
  if (boundary == 0) return;
  Matrix(r + pivots, boundary, columns, Eigen::OuterStride<>(ldr)).noalias() -=
      ConstMatrix(L + pivots, boundary, pivots, Eigen::OuterStride<>(ld)) * top;
}

void backward(const double* L, int ld, int pivots, int boundary, double* x) {
  if (pivots == 0) return;
  Eigen::Map<Eigen::VectorXd> top(x, pivots);
  if (boundary > 0) {
    top.noalias() -= ConstMatrix(L + pivots, boundary, pivots, Eigen::OuterStride<>(ld)).transpose() *
                     Eigen::Map<const Eigen::VectorXd>(x + pivots, boundary);
  }
  ConstMatrix(L, pivots, pivots, Eigen::OuterStride<>(ld)).transpose().triangularView<Eigen::Upper>().solveInPlace(top);
}

void invert_panel(const double* L, int ld, int pivots, int boundary, float* W, int ldw) {
  if (pivots == 0) return;
  const ConstMatrix panel(L, pivots + boundary, pivots, Eigen::OuterStride<>(ld));
  Eigen::MatrixXd inverse = Eigen::MatrixXd::Identity(pivots, pivots);
  panel.topRows(pivots).triangularView<Eigen::Lower>().solveInPlace(inverse);
  Eigen::Map<Eigen::MatrixXf, 0, Eigen::OuterStride<>> out(W, pivots + boundary, pivots, Eigen::OuterStride<>(ldw));
  out.topRows(pivots) = inverse.cast<float>();
  if (boundary > 0) out.bottomRows(boundary) = (panel.bottomRows(boundary) * inverse).eval().cast<float>();
}

#if defined(__AVX512F__)
constexpr int kPacket = 16;
constexpr int kRegisters = 24;  // for sums
#elif defined(__AVX2__)
constexpr int kPacket = 8;
constexpr int kRegisters = 8;
#else
constexpr int kPacket = 4;
constexpr int kRegisters = 8;
#endif
typedef float Packet __attribute__((vector_size(4 * kPacket)));
typedef float PacketInMemory __attribute__((vector_size(4 * kPacket), aligned(4), may_alias));

Packet load(const float* from) { return *reinterpret_cast<const PacketInMemory*>(from); }
void store(Packet value, float* to) { *reinterpret_cast<PacketInMemory*>(to) = value; }
float sum_of(Packet value) {
  float part[kPacket];
  store(value, part);
  for (int width = kPacket / 2; width > 0; width /= 2) {
    for (int i = 0; i < width; ++i) part[i] += part[i + width];
  }
  return part[0];
}

/// Some packets of rows at a time, whose sums stay in registers.
template <int lanes, int packets>
void multiply_rows(const float* W, int ld, int columns, const float* X, int ldx, float* Y, int ldy) {
  Packet sum[packets][lanes] = {};
  for (int j = 0; j < columns; ++j) {
    const float* const w = W + static_cast<std::ptrdiff_t>(j) * ld;
    RHEXIS_UNROLLED
    for (int p = 0; p < packets; ++p) {
      const Packet value = load(w + p * kPacket);
      RHEXIS_UNROLLED
      for (int l = 0; l < lanes; ++l) sum[p][l] += value * X[l * ldx + j];
    }
  }
  RHEXIS_UNROLLED
  for (int p = 0; p < packets; ++p) {
    RHEXIS_UNROLLED
    for (int l = 0; l < lanes; ++l) store(sum[p][l], Y + l * ldy + p * kPacket);
  }
}

template <int lanes>
void multiply_lanes(const float* W, int ld, int rows, int columns, const float* X, int ldx, float* Y, int ldy) {
  constexpr int kTogether = kRegisters / lanes < 8 ? kRegisters / lanes : 8;
  int i = 0;
  for (; i + kTogether * kPacket <= rows; i += kTogether * kPacket)
    multiply_rows<lanes, kTogether>(W + i, ld, columns, X, ldx, Y + i, ldy);
  for (; i < rows; i += kPacket) multiply_rows<lanes, 1>(W + i, ld, columns, X, ldx, Y + i, ldy);
}

void multiply_single(const float* W, int ld, int rows, int columns, int lanes, const float* X, int ldx, float* Y,
                     int ldy) {
  if (lanes == 1) multiply_lanes<1>(W, ld, rows, columns, X, ldx, Y, ldy);
  if (lanes == 2) multiply_lanes<2>(W, ld, rows, columns, X, ldx, Y, ldy);
  if (lanes == 4) multiply_lanes<4>(W, ld, rows, columns, X, ldx, Y, ldy);
}

template <int lanes, int together>
void multiply_columns(const float* W, int ld, int rows, const float* X, int ldx, float* Y, int ldy) {
  Packet sum[together][lanes] = {};
  for (int i = 0; i < rows; i += kPacket) {
    RHEXIS_UNROLLED
    for (int c = 0; c < together; ++c) {
      const Packet value = load(W + static_cast<std::ptrdiff_t>(c) * ld + i);
      RHEXIS_UNROLLED
      for (int l = 0; l < lanes; ++l) sum[c][l] += value * load(X + l * ldx + i);
    }
  }
  RHEXIS_UNROLLED
  for (int c = 0; c < together; ++c) {
    RHEXIS_UNROLLED
    for (int l = 0; l < lanes; ++l) Y[l * ldy + c] = sum_of(sum[c][l]);
  }
}

template <int lanes>
void multiply_transposed_lanes(const float* W, int ld, int rows, int columns, const float* X, int ldx, float* Y,
                               int ldy) {
  constexpr int kTogether = kRegisters / lanes < 8 ? kRegisters / lanes : 8;
  const auto column = [&](int j) { return W + static_cast<std::ptrdiff_t>(j) * ld; };
  int j = 0;
  for (; j + kTogether <= columns; j += kTogether)
    multiply_columns<lanes, kTogether>(column(j), ld, rows, X, ldx, Y + j, ldy);
  for (; j < columns; ++j) multiply_columns<lanes, 1>(column(j), ld, rows, X, ldx, Y + j, ldy);
}

void multiply_transposed_single(const float* W, int ld, int rows, int columns, int lanes, const float* X, int ldx,
                                float* Y, int ldy) {
  if (lanes == 1) multiply_transposed_lanes<1>(W, ld, rows, columns, X, ldx, Y, ldy);
  if (lanes == 2) multiply_transposed_lanes<2>(W, ld, rows, columns, X, ldx, Y, ldy);
  if (lanes == 4) multiply_transposed_lanes<4>(W, ld, rows, columns, X, ldx, Y, ldy);
}

void add(double* to, const double* from, int count) {
  Eigen::Map<Eigen::VectorXd>(to, count) += Eigen::Map<const Eigen::VectorXd>(from, count);
}

}  // namespace

FrontKernels make_front_kernels() {
  return {factor,   solve_rows,   subtract_lower,  forward,
          backward, invert_panel, multiply_single, multiply_transposed_single,
          add};
}

}  // namespace rhexis::linalg::RHEXIS_SIMD_NAMESPACE
