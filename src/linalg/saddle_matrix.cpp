#include "linalg/saddle_matrix.h"

#include <utility>

#include "base/check.h"

namespace rhexis::linalg {
namespace {

/// y += S x.
void add_skew(const BlockPattern& pattern, const SkewBlocks& skew, const VectorX& x, VectorX& y) {
  for (std::int32_t row = 0; row < pattern.rows(); ++row) {
    for (std::int32_t k = pattern.row_start[static_cast<std::size_t>(row)];
         k < pattern.row_start[static_cast<std::size_t>(row) + 1]; ++k) {
      const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> s(skew.values.data() +
                                                                             9 * std::ptrdiff_t{k});
      const std::int32_t col = pattern.column[static_cast<std::size_t>(k)];
      y.segment<3>(3 * row) += s * x.segment<3>(3 * col);
      if (col != row) y.segment<3>(3 * col) -= s.transpose() * x.segment<3>(3 * row);
    }
  }
}

}  // namespace

CouplingMatrix::CouplingMatrix(std::shared_ptr<const CsrPattern> of) : pattern(std::move(of)) {
  values.assign(3 * pattern->column.size(), 0.0);
}

void CouplingMatrix::multiply(const VectorX& u, VectorX& p) const {
  RHEXIS_CHECK(p.size() == rows(), "{} rows, p {}", rows(), p.size());
  for (std::int32_t row = 0; row < rows(); ++row) {
    const auto first = static_cast<std::size_t>(pattern->row_start[static_cast<std::size_t>(row)]);
    const auto last = static_cast<std::size_t>(pattern->row_start[static_cast<std::size_t>(row) + 1]);
    double sum = 0.0;
    for (std::size_t k = first; k < last; ++k) {
      const double* const b = values.data() + 3 * k;
      const double* const v = u.data() + 3 * static_cast<std::size_t>(pattern->column[k]);
      sum += b[0] * v[0] + b[1] * v[1] + b[2] * v[2];
    }
    p[row] = sum;
  }
}

void CouplingMatrix::add_transposed(const VectorX& p, double scale, VectorX& u) const {
  RHEXIS_CHECK(p.size() == rows(), "{} rows, p {}", rows(), p.size());
  for (std::int32_t row = 0; row < rows(); ++row) {
    const auto first = static_cast<std::size_t>(pattern->row_start[static_cast<std::size_t>(row)]);
    const auto last = static_cast<std::size_t>(pattern->row_start[static_cast<std::size_t>(row) + 1]);
    const double factor = scale * p[row];
    for (std::size_t k = first; k < last; ++k) {
      const double* const b = values.data() + 3 * k;
      double* const v = u.data() + 3 * static_cast<std::size_t>(pattern->column[k]);
      v[0] += factor * b[0];
      v[1] += factor * b[1];
      v[2] += factor * b[2];
    }
  }
}

SymmetricCsr::SymmetricCsr(std::shared_ptr<const CsrPattern> of) : pattern(std::move(of)) {
  values.assign(pattern->column.size(), 0.0);
}

void SymmetricCsr::multiply(const VectorX& x, VectorX& y) const {
  y.setZero();
  add_product(x, 1.0, y);
}

void SymmetricCsr::add_product(const VectorX& x, double scale, VectorX& y) const {
  RHEXIS_CHECK(x.size() == rows() && y.size() == x.size(), "{} rows, x {}, y {}", rows(), x.size(), y.size());
  for (std::int32_t row = 0; row < rows(); ++row) {
    const auto first = static_cast<std::size_t>(pattern->row_start[static_cast<std::size_t>(row)]);
    const auto diagonal = static_cast<std::size_t>(pattern->row_start[static_cast<std::size_t>(row) + 1]) - 1;
    const double scaled = scale * x[row];
    double sum = values[diagonal] * x[row];
    for (std::size_t k = first; k < diagonal; ++k) {
      const std::int32_t col = pattern->column[k];
      sum += values[k] * x[col];
      y[col] += values[k] * scaled;
    }
    y[row] += scale * sum;
  }
}

void SaddleMatrix::multiply(const VectorX& xu, const VectorX& xp, VectorX& yu, VectorX& yp) const {
  A.multiply(xu, yu);
  if (skew) add_skew(*A.pattern, *skew, xu, yu);
  if (pressure_unknowns() == 0) return;
  B.add_transposed(xp, 1.0, yu);
  B.multiply(xu, yp);
  C.add_product(xp, -1.0, yp);
}

FreeDofs make_free_dofs(const std::vector<bool>& held) {
  FreeDofs free;
  free.index.assign(held.size(), -1);
  for (std::size_t dof = 0; dof < held.size(); ++dof) {
    if (held[dof]) continue;
    free.index[dof] = free.count();
    free.dof.push_back(static_cast<std::int32_t>(dof));
  }
  return free;
}

}  // namespace rhexis::linalg
