#include "linalg/condensed_preconditioner.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace rhexis::linalg {
namespace {

/// Calls use(pressure, k_row, k_col) for every pair of entries of a row of B^T with k_col <= k_row.
template <class Use>
void for_each_pair(const CsrPattern& pattern, const Use& use) {
  for (std::int32_t p = 0; p < pattern.rows(); ++p) {
    const auto first = static_cast<std::size_t>(pattern.row_start[static_cast<std::size_t>(p)]);
    const auto last = static_cast<std::size_t>(pattern.row_start[static_cast<std::size_t>(p) + 1]);
    for (std::size_t i = first; i < last; ++i) {
      for (std::size_t j = first; j <= i; ++j) use(p, i, j);
    }
  }
}

/// A's pattern when that holds every pair of nodes of a pressure, as it does for pressures per tet; else the union of
/// both, as for pressures at vertices, which couple all nodes around them.
std::shared_ptr<const BlockPattern> pattern_of_sum(const SaddleMatrix& K) {
  const CsrPattern& b = *K.B.pattern;
  bool covers = true;
  for_each_pair(b, [&](std::int32_t, std::size_t i, std::size_t j) {
    covers = covers && K.A.pattern->find(b.column[i], b.column[j]) >= 0;
  });
  if (covers) return K.A.pattern;
  std::vector<std::int32_t> pairs;
  for (std::int32_t row = 0; row < K.A.rows(); ++row) {
    for (std::int32_t k = K.A.pattern->row_start[static_cast<std::size_t>(row)];
         k < K.A.pattern->row_start[static_cast<std::size_t>(row) + 1]; ++k) {
      pairs.insert(pairs.end(), {row, K.A.pattern->column[static_cast<std::size_t>(k)]});
    }
  }
  for_each_pair(b, [&](std::int32_t, std::size_t i, std::size_t j) {
    pairs.insert(pairs.end(), {b.column[i], b.column[j]});
  });
  return std::make_shared<const BlockPattern>(make_block_pattern(K.A.rows(), pairs, 2));
}

}  // namespace

CholeskyOutcome CondensedPreconditioner::analyse(const SaddleMatrix& K, const FreeDofs& free) {
  P_ = SymmetricBlockMatrix(pattern_of_sum(K));
  a_block_.clear();
  if (P_.pattern != K.A.pattern) {
    for (std::int32_t row = 0; row < K.A.rows(); ++row) {
      for (std::int32_t k = K.A.pattern->row_start[static_cast<std::size_t>(row)];
           k < K.A.pattern->row_start[static_cast<std::size_t>(row) + 1]; ++k) {
        a_block_.push_back(P_.pattern->find(row, K.A.pattern->column[static_cast<std::size_t>(k)]));
      }
    }
  }
  pair_block_.clear();
  for_each_pair(*K.B.pattern, [&](std::int32_t, std::size_t i, std::size_t j) {
    pair_block_.push_back(P_.pattern->find(K.B.pattern->column[i], K.B.pattern->column[j]));
  });
  return factor_.analyse(*P_.pattern, free);
}

void CondensedPreconditioner::set_c(const SaddleMatrix& K, CholeskyFactor& c_factor) {
  patches_.set(K, [&](const Eigen::MatrixXd& b, Eigen::MatrixXd& x) { c_factor.solve(b, x); });
}

void CondensedPreconditioner::assemble(const SaddleMatrix& K) {
  if (a_block_.empty()) {
    P_.values = K.A.values;
  } else {
    P_.set_zero();
    for (std::size_t k = 0; k < a_block_.size(); ++k) {
      std::copy_n(K.A.values.begin() + 9 * static_cast<std::ptrdiff_t>(k), 9,
                  P_.values.begin() + 9 * std::ptrdiff_t{a_block_[k]});
    }
  }
  std::size_t pair = 0;
  for_each_pair(*K.B.pattern, [&](std::int32_t p, std::size_t i, std::size_t j) {
    double* const to = P_.values.data() + 9 * static_cast<std::size_t>(pair_block_[pair++]);
    const double* const bi = K.B.values.data() + 3 * i;
    const double* const bj = K.B.values.data() + 3 * j;
    const double weight = 1.0 / patches_.diagonal()[p];
    for (std::size_t a = 0; a < 3; ++a) {
      for (std::size_t b = 0; b < 3; ++b) to[3 * a + b] += weight * bi[a] * bj[b];
    }
  });
}

CholeskyOutcome CondensedPreconditioner::factor(const SaddleMatrix& K, const FreeDofs& free) {
  assemble(K);
  CholeskyOutcome outcome = factor_.factor(P_.values);
  constexpr double kFirstShift = 0.03;
  constexpr double kLargestShift = 3.0;  // of the diagonal
  shift_ = 0.0;
  for (double next = kFirstShift; outcome == CholeskyOutcome::not_positive_definite && next <= kLargestShift;
       next *= 10.0) {
    for (std::int32_t row = 0; row < P_.rows(); ++row) {
      const auto block = static_cast<std::size_t>(P_.pattern->row_start[static_cast<std::size_t>(row) + 1]) - 1;
      for (std::size_t c : {0U, 4U, 8U})
        P_.values[9 * block + c] += (next - shift_) * std::abs(P_.values[9 * block + c]);
    }
    shift_ = next;
    outcome = factor_.factor(P_.values);
  }
  if (outcome == CholeskyOutcome::ok)
    patches_.correct(K, free, [&](const Eigen::MatrixXd& b, Eigen::MatrixXd& x) { factor_.solve(b, x); });
  return outcome;
}

void CondensedPreconditioner::solve(const VectorX& r, VectorX& z) {
  factor_.solve(r, z);
  patches_.apply(r, z);
}

std::size_t CondensedPreconditioner::memory_bytes() const {
  return factor_.memory_bytes() + sizeof(std::int32_t) * (a_block_.capacity() + pair_block_.capacity()) +
         sizeof(double) * P_.values.capacity() + patches_.memory_bytes();
}

}  // namespace rhexis::linalg
