#include "linalg/saddle_matrix.h"

#include <utility>

#include "base/check.h"

namespace rhexis::linalg {
namespace {

/// y += S x.
template <int k>
void add_skew(const BlockPattern& pattern, const SkewBlocks& skew, const Lanes<k>& x, Lanes<k>& y) {
  for (std::int32_t row = 0; row < pattern.rows(); ++row) {
    for (std::int32_t i = pattern.row_start[static_cast<std::size_t>(row)];
         i < pattern.row_start[static_cast<std::size_t>(row) + 1]; ++i) {
      const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> s(skew.values.data() +
                                                                             9 * std::ptrdiff_t{i});
      const std::int32_t col = pattern.column[static_cast<std::size_t>(i)];
      y.template middleRows<3>(3 * row) += s * x.template middleRows<3>(3 * col);
      if (col != row) y.template middleRows<3>(3 * col) -= s.transpose() * x.template middleRows<3>(3 * row);
    }
  }
}

}  // namespace

CouplingMatrix::CouplingMatrix(std::shared_ptr<const CsrPattern> of) : pattern(std::move(of)) {
  values.assign(3 * pattern->column.size(), 0.0);
}

template <int k>
void CouplingMatrix::multiply(const Lanes<k>& u, Lanes<k>& p) const {
  RHEXIS_CHECK(p.rows() == rows(), "{} rows, p {}", rows(), p.rows());
  using Row = Eigen::Array<double, k, 1>;
  using Given = Eigen::Map<const Row>;
  for (std::int32_t row = 0; row < rows(); ++row) {
    const auto first = static_cast<std::size_t>(pattern->row_start[static_cast<std::size_t>(row)]);
    const auto last = static_cast<std::size_t>(pattern->row_start[static_cast<std::size_t>(row) + 1]);
    Row sum = Row::Zero();
    for (std::size_t i = first; i < last; ++i) {
      const double* const b = values.data() + 3 * i;
      const double* const v = u.data() + 3 * k * static_cast<std::size_t>(pattern->column[i]);
      sum += b[0] * Given(v) + b[1] * Given(v + k) + b[2] * Given(v + 2 * k);
    }
    Eigen::Map<Row>(p.data() + static_cast<std::ptrdiff_t>(k) * row) = sum;
  }
}

template <int k>
void CouplingMatrix::add_transposed(const Lanes<k>& p, double scale, Lanes<k>& u) const {
  RHEXIS_CHECK(p.rows() == rows(), "{} rows, p {}", rows(), p.rows());
  using Row = Eigen::Array<double, k, 1>;
  for (std::int32_t row = 0; row < rows(); ++row) {
    const auto first = static_cast<std::size_t>(pattern->row_start[static_cast<std::size_t>(row)]);
    const auto last = static_cast<std::size_t>(pattern->row_start[static_cast<std::size_t>(row) + 1]);
    const Row factor = scale * Eigen::Map<const Row>(p.data() + static_cast<std::ptrdiff_t>(k) * row);
    for (std::size_t i = first; i < last; ++i) {
      const double* const b = values.data() + 3 * i;
      double* const v = u.data() + 3 * k * static_cast<std::size_t>(pattern->column[i]);
      for (std::ptrdiff_t c = 0; c < 3; ++c) Eigen::Map<Row>(v + c * k) += factor * b[c];
    }
  }
}

void CouplingMatrix::multiply(const VectorX& u, VectorX& p) const { multiply<1>(u, p); }
void CouplingMatrix::add_transposed(const VectorX& p, double scale, VectorX& u) const {
  add_transposed<1>(p, scale, u);
}

SymmetricCsr::SymmetricCsr(std::shared_ptr<const CsrPattern> of) : pattern(std::move(of)) {
  values.assign(pattern->column.size(), 0.0);
}

void SymmetricCsr::multiply(const VectorX& x, VectorX& y) const {
  y.setZero();
  add_product(x, 1.0, y);
}

template <int k>
void SymmetricCsr::add_product(const Lanes<k>& x, double scale, Lanes<k>& y) const {
  RHEXIS_CHECK(x.rows() == rows() && y.rows() == x.rows(), "{} rows, x {}, y {}", rows(), x.rows(), y.rows());
  for (std::int32_t row = 0; row < rows(); ++row) {
    const auto first = static_cast<std::size_t>(pattern->row_start[static_cast<std::size_t>(row)]);
    const auto diagonal = static_cast<std::size_t>(pattern->row_start[static_cast<std::size_t>(row) + 1]) - 1;
    const PerLane<k> own = x.row(row);
    const PerLane<k> scaled = scale * own;
    PerLane<k> sum = values[diagonal] * own;
    for (std::size_t i = first; i < diagonal; ++i) {
      const std::int32_t col = pattern->column[i];
      sum += values[i] * x.row(col).array();
      y.row(col).array() += values[i] * scaled;
    }
    y.row(row).array() += scale * sum;
  }
}

void SymmetricCsr::add_product(const VectorX& x, double scale, VectorX& y) const { add_product<1>(x, scale, y); }

template <int k>
void SaddleMatrix::multiply(const Lanes<k>& xu, const Lanes<k>& xp, Lanes<k>& yu, Lanes<k>& yp) const {
  A.multiply(xu, yu);
  if (skew) add_skew<k>(*A.pattern, *skew, xu, yu);
  if (pressure_unknowns() == 0) return;
  B.add_transposed(xp, 1.0, yu);
  B.multiply(xu, yp);
  C.add_product(xp, -1.0, yp);
}

void SaddleMatrix::multiply(const VectorX& xu, const VectorX& xp, VectorX& yu, VectorX& yp) const {
  multiply<1>(xu, xp, yu, yp);
}

template void CouplingMatrix::multiply<2>(const TwoLanes&, TwoLanes&) const;
template void CouplingMatrix::multiply<4>(const FourLanes&, FourLanes&) const;
template void CouplingMatrix::add_transposed<2>(const TwoLanes&, double, TwoLanes&) const;
template void CouplingMatrix::add_transposed<4>(const FourLanes&, double, FourLanes&) const;
template void SymmetricCsr::add_product<2>(const TwoLanes&, double, TwoLanes&) const;
template void SymmetricCsr::add_product<4>(const FourLanes&, double, FourLanes&) const;
template void SaddleMatrix::multiply<2>(const TwoLanes&, const TwoLanes&, TwoLanes&, TwoLanes&) const;
template void SaddleMatrix::multiply<4>(const FourLanes&, const FourLanes&, FourLanes&, FourLanes&) const;

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
