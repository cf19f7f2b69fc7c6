#include "linalg/condensed_preconditioner.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "linalg/patches.h"
#include "linalg/saddle_residual.h"

namespace rhexis::linalg {
namespace {

/// Pressures in a patch and most patches: docs/solvers.md has the iteration counts that they were chosen by.
constexpr std::int32_t kPatchSize = 100;
constexpr std::int32_t kMostPatches = 16;
/// Least tr(B D^-1 B^T) / tr(A): about a bulk stiffness of 1.2 mu for pressures that C damps.
constexpr double kBulkShare = 0.36;

double trace(const SymmetricBlockMatrix& A) {
  double sum = 0.0;
  for (std::int32_t row = 0; row < A.rows(); ++row) {
    const auto block = static_cast<std::size_t>(A.pattern->row_start[static_cast<std::size_t>(row) + 1]) - 1;
    for (std::size_t c : {0U, 4U, 8U}) sum += A.values[9 * block + c];
  }
  return sum;
}

/// tr(B diag(d)^-1 B^T).
double trace_of_product(const CouplingMatrix& B, const VectorX& d) {
  double sum = 0.0;
  for (std::int32_t p = 0; p < B.rows(); ++p) {
    const auto first = static_cast<std::size_t>(B.pattern->row_start[static_cast<std::size_t>(p)]);
    const auto last = static_cast<std::size_t>(B.pattern->row_start[static_cast<std::size_t>(p) + 1]);
    for (std::size_t i = 3 * first; i < 3 * last; ++i) sum += B.values[i] * B.values[i] / d[p];
  }
  return sum;
}

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
  const SymmetricCsr& C = K.C;
  const std::int32_t m = C.rows();
  d_.resize(m);
  for (std::int32_t p = 0; p < m; ++p) {
    d_[p] = C.values[static_cast<std::size_t>(C.pattern->row_start[static_cast<std::size_t>(p) + 1]) - 1];
  }
  smooth_.resize(m, 0);
  G_.resize(0, 0);
  const bool diagonal = static_cast<std::int32_t>(C.pattern->column.size()) == m;
  if (diagonal) return;  // E = 0: P is S
  const double bulk = trace_of_product(K.B, d_);
  const std::vector<std::int32_t> patch =
      cut_into_patches(*C.pattern, std::max(kPatchSize, (m - 1) / kMostPatches + 1));
  const std::int32_t count = *std::max_element(patch.begin(), patch.end()) + 1;
  smooth_.setZero(m, count);
  for (std::int32_t p = 0; p < m; ++p) smooth_(p, patch[static_cast<std::size_t>(p)]) = 1.0;
  c_factor.solve(smooth_, smooth_);
  Eigen::MatrixXd of_c = Eigen::MatrixXd::Zero(count, count);  // W^T C^-1 W
  VectorX of_d = VectorX::Zero(count);                         // W^T diag(C)^-1 W
  for (std::int32_t p = 0; p < m; ++p) {
    of_c.row(patch[static_cast<std::size_t>(p)]) += smooth_.row(p);
    of_d[patch[static_cast<std::size_t>(p)]] += 1.0 / d_[p];
  }
  // The patches have to be smoother than the weight makes up for: G definite. Less weight makes it so, unless C = D up
  // to rounding or the patches oscillate; there is nothing to put back then.
  double weight = std::max(1.0, bulk > 0.0 ? kBulkShare * trace(K.A) / bulk : 1.0);
  for (;; weight = std::max(1.0, 0.5 * weight)) {
    G_ = of_c;
    G_.diagonal() -= weight * of_d;
    if (Eigen::LLT<Eigen::MatrixXd>(G_).info() == Eigen::Success) break;
    if (weight == 1.0) {
      smooth_.resize(m, 0);
      G_.resize(0, 0);
      return;
    }
  }
  d_ /= weight;
  for (std::int32_t p = 0; p < m; ++p) smooth_(p, patch[static_cast<std::size_t>(p)]) -= 1.0 / d_[p];
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
    const double weight = 1.0 / d_[p];
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
  if (outcome == CholeskyOutcome::ok) correct(K, free);
  return outcome;
}

void CondensedPreconditioner::correct(const SaddleMatrix& K, const FreeDofs& free) {
  const Eigen::Index count = smooth_.cols();
  V_.setZero(K.displacement_unknowns(), count);
  if (count == 0) return;
  VectorX pressure(smooth_.rows());
  VectorX force(V_.rows());
  for (Eigen::Index col = 0; col < count; ++col) {
    pressure = smooth_.col(col);
    force.setZero();
    K.B.add_transposed(pressure, 1.0, force);
    clear_held(free, force);
    V_.col(col) = force;
  }
  Eigen::MatrixXd solved(V_.rows(), count);
  factor_.solve(V_, solved);
  Eigen::MatrixXd inner = G_;
  inner.noalias() += V_.transpose() * solved;
  coarse_.compute(inner);
  V_ = std::move(solved);
  small_.resize(count);
}

void CondensedPreconditioner::solve(const VectorX& r, VectorX& z) {
  factor_.solve(r, z);
  if (patches() == 0) return;
  small_.noalias() = V_.transpose() * r;
  coarse_.solveInPlace(small_);
  z.noalias() -= V_ * small_;
}

std::size_t CondensedPreconditioner::memory_bytes() const {
  return factor_.memory_bytes() + sizeof(std::int32_t) * (a_block_.capacity() + pair_block_.capacity()) +
         sizeof(double) *
             (P_.values.capacity() + static_cast<std::size_t>(d_.size() + smooth_.size() + V_.size() + 2 * G_.size()));
}

}  // namespace rhexis::linalg
