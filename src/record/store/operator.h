#pragma once

/// The global operator of a topology, K^-1, as the sparse Cholesky factor of its stiffness: one order and one pattern
/// for all topologies of a record, since keep-nodes takes tets away and moves nodes, and adds nothing.

#include <cstdint>
#include <span>
#include <vector>

#include "base/vec.h"

namespace rhexis::record::store {

/// L of P K P^T = L L^T by columns; rows and columns are the free dofs of the intact body in the order of their
/// elimination. A dof out of the solve has a column of one entry that is not zero, 1.
struct OperatorPattern {
  std::vector<std::int32_t> dof;    ///< per row: 3 node + component
  std::vector<std::int64_t> start;  ///< rows + 1 offsets into `row`
  std::vector<std::int32_t> row;    ///< of a column: its own first, then ascending

  [[nodiscard]] std::int32_t rows() const { return static_cast<std::int32_t>(dof.size()); }
  [[nodiscard]] std::size_t entries() const { return row.size(); }
  friend bool operator==(const OperatorPattern&, const OperatorPattern&) = default;
};

/// x = L^-T L^-1 x in place, in the order of the rows, computed in double. `values`: one per entry of the pattern.
template <class Value>
void solve_in_order(const OperatorPattern& pattern, std::span<const Value> values, VectorX& x) {
  const std::int32_t rows = pattern.rows();
  for (std::int32_t j = 0; j < rows; ++j) {
    const auto begin = static_cast<std::size_t>(pattern.start[static_cast<std::size_t>(j)]);
    const auto end = static_cast<std::size_t>(pattern.start[static_cast<std::size_t>(j) + 1]);
    const double y = x[j] / static_cast<double>(values[begin]);
    x[j] = y;
    for (std::size_t p = begin + 1; p < end; ++p) x[pattern.row[p]] -= static_cast<double>(values[p]) * y;
  }
  for (std::int32_t j = rows - 1; j >= 0; --j) {
    const auto begin = static_cast<std::size_t>(pattern.start[static_cast<std::size_t>(j)]);
    const auto end = static_cast<std::size_t>(pattern.start[static_cast<std::size_t>(j) + 1]);
    double y = x[j];
    for (std::size_t p = begin + 1; p < end; ++p) y -= static_cast<double>(values[p]) * x[pattern.row[p]];
    x[j] = y / static_cast<double>(values[begin]);
  }
}

/// Displacement (m) by forces (N), both 3 per node; held dofs come out zero.
template <class Value>
VectorX displacement_by(const OperatorPattern& pattern, std::span<const Value> values, const VectorX& force) {
  VectorX x(pattern.rows());
  for (std::int32_t i = 0; i < pattern.rows(); ++i) x[i] = force[pattern.dof[static_cast<std::size_t>(i)]];
  solve_in_order(pattern, values, x);
  VectorX u = VectorX::Zero(force.size());
  for (std::int32_t i = 0; i < pattern.rows(); ++i) u[pattern.dof[static_cast<std::size_t>(i)]] = x[i];
  return u;
}

}  // namespace rhexis::record::store
