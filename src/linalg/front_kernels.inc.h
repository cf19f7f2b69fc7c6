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

#define RHEXIS_JOIN_NAMES(a, b) a##_##b
#define RHEXIS_JOIN(a, b) RHEXIS_JOIN_NAMES(a, b)
#define Eigen RHEXIS_JOIN(Eigen_fronts, RHEXIS_SIMD_NAMESPACE)
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

using Narrow = Eigen::Matrix<double, kFactorWidth, kFactorWidth>;

/// Few columns: L in place, R = L^-T, and the rows below times R, a product where a solve would go column by column.
/// On copies of fixed size, whose columns are a few registers; unused rows and columns are those of the identity.
bool factor_narrow(double* A, int rows, int columns, int ld, double* work) {
  Matrix given(A, rows, columns, Eigen::OuterStride<>(ld));
  Narrow L = Narrow::Identity();
  for (int j = 0; j < columns; ++j) L.col(j).segment(j, columns - j) = given.col(j).segment(j, columns - j);
  Narrow R = Narrow::Identity();
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
  const int below = rows - columns;
  if (below == 0) return true;
  Matrix copy(work, below, columns, Eigen::OuterStride<>(below));
  copy = given.bottomRows(below);
  given.bottomRows(below).noalias() = copy * R.topLeftCorner(columns, columns);
  return true;
}

/// Left half, its effect on the right half, right half: all but narrow blocks is in products.
bool factor(double* A, int rows, int columns, int ld, double* work) {
  if (columns <= kFactorWidth) return factor_narrow(A, rows, columns, ld, work);
  const int left = (columns / 2 + kFactorWidth - 1) / kFactorWidth * kFactorWidth;
  if (!factor(A, rows, left, ld, work)) return false;
  double* const right = A + static_cast<std::ptrdiff_t>(left) * ld + left;
  // By blocks of columns, since nothing above the diagonal is needed.
  constexpr int kBlock = 2 * kFactorWidth;
  for (int j = left; j < columns; j += kBlock) {
    const int count = columns - j < kBlock ? columns - j : kBlock;
    subtract_product(A + static_cast<std::ptrdiff_t>(j) * ld + j, ld, A + j, A + j, ld, rows - j, count, left);
  }
  return factor(right, rows - left, columns - left, ld, work);
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
  Eigen::Map<Eigen::VectorXd> top(x, pivots);
  if (boundary > 0) {
    top.noalias() -= ConstMatrix(L + pivots, boundary, pivots, Eigen::OuterStride<>(ld)).transpose() *
                     Eigen::Map<const Eigen::VectorXd>(x + pivots, boundary);
  }
  ConstMatrix(L, pivots, pivots, Eigen::OuterStride<>(ld)).transpose().triangularView<Eigen::Upper>().solveInPlace(top);
}

void add(double* to, const double* from, int count) {
  Eigen::Map<Eigen::VectorXd>(to, count) += Eigen::Map<const Eigen::VectorXd>(from, count);
}

}  // namespace

FrontKernels make_front_kernels() { return {factor, subtract_product, forward, backward, add}; }

}  // namespace rhexis::linalg::RHEXIS_SIMD_NAMESPACE
