#include "linalg/chebyshev_inverse.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include <Eigen/Eigenvalues>

#include "base/check.h"
#include "base/parallel.h"
#include "linalg/patches.h"

namespace rhexis::linalg {
namespace {

/// Rows times lanes that one thread takes at a time.
constexpr std::size_t kGrain = 16384;
constexpr std::int32_t kPatchSize = 60;
constexpr std::int32_t kMostPatches = 512;
constexpr int kLanczosSteps = 120;
constexpr int kLanczosCheck = 20;  ///< steps after which the estimate is looked at again
constexpr double kLanczosChange = 0.01;
constexpr double kExhausted = 1e-8;
/// Of Lanczos' estimate, which is from above.
constexpr double kSafety = 0.7;

std::size_t at(Eigen::Index i) { return static_cast<std::size_t>(i); }

double smallest_of_tridiagonal(const std::vector<double>& diagonal, const std::vector<double>& below) {
  const auto count = static_cast<Eigen::Index>(diagonal.size());
  Eigen::MatrixXd T = Eigen::MatrixXd::Zero(count, count);
  for (Eigen::Index k = 0; k < count; ++k) {
    T(k, k) = diagonal[at(k)];
    if (k > 0) T(k, k - 1) = T(k - 1, k) = below[at(k)];
  }
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(T, Eigen::EigenvaluesOnly).eigenvalues()[0];
}

}  // namespace

ChebyshevInverse::ChebyshevInverse(const SymmetricCsr& C, double reduction) : rows_(C.rows()) {
  Scaled exact = take_matrix(C);
  if (col_.empty()) return;
  take_patches(exact);
  // Gershgorin's circles of D^-1 C, which has the same eigenvalues.
  double radius = 0.0;
  for (Eigen::Index i = 0; i < rows_; ++i) {
    double off = 0.0;
    for (std::size_t p = width_ * at(i); p < width_ * (at(i) + 1); ++p)
      off += std::abs(exact.value[p]) * exact.root[i] / exact.root[col_[p]];
    radius = std::max(radius, off);
  }
  RHEXIS_CHECK(radius < 1.0, "not diagonally dominant: {}", radius);
  const double high = 1.0 + radius;
  const double low = std::max(1.0 - radius, kSafety * smallest_eigenvalue(exact));
  centre_ = static_cast<float>(0.5 * (high + low));
  half_width_ = static_cast<float>(0.5 * (high - low));
  // Error after k steps: at most 1 / T_k(centre / half width).
  steps_ =
      std::max(1, static_cast<int>(std::ceil(std::acosh(1.0 / reduction) / std::acosh((high + low) / (high - low)))));
}

ChebyshevInverse::Scaled ChebyshevInverse::take_matrix(const SymmetricCsr& C) {
  const CsrPattern& pattern = *C.pattern;
  const bool diagonal = static_cast<Eigen::Index>(pattern.column.size()) == rows_;
  std::vector<std::int32_t> patch(at(rows_), 0);
  if (!diagonal)
    patch = cut_into_patches(pattern, std::max(kPatchSize, static_cast<std::int32_t>((rows_ - 1) / kMostPatches + 1)));
  row_of_.resize(at(rows_));
  std::iota(row_of_.begin(), row_of_.end(), 0);
  std::stable_sort(row_of_.begin(), row_of_.end(),
                   [&](std::int32_t a, std::int32_t b) { return patch[at(a)] < patch[at(b)]; });
  std::vector<std::int32_t> place(at(rows_));
  Scaled exact;
  exact.root.resize(rows_);
  for (Eigen::Index i = 0; i < rows_; ++i) {
    const std::int32_t row = row_of_[at(i)];
    place[at(row)] = static_cast<std::int32_t>(i);
    const double d = C.values[at(pattern.row_start[at(row) + 1]) - 1];
    RHEXIS_CHECK(d > 0.0, "diagonal {} in row {}", d, row);
    exact.root[i] = 1.0 / std::sqrt(d);
    if (i > 0 && patch[at(row)] != patch[at(row_of_[at(i) - 1])]) patch_start_.push_back(static_cast<std::int32_t>(i));
  }
  patch_start_.push_back(static_cast<std::int32_t>(rows_));
  const auto for_each_entry = [&](const auto& use) {
    for (Eigen::Index row = 0; row < rows_; ++row) {
      for (std::int32_t k = pattern.row_start[at(row)]; k + 1 < pattern.row_start[at(row) + 1]; ++k) {
        if (C.values[at(k)] != 0.0) use(place[at(row)], place[at(pattern.column[at(k)])], C.values[at(k)]);
      }
    }
  };
  std::vector<std::size_t> used(at(rows_), 0);
  for_each_entry([&](std::int32_t i, std::int32_t j, double) {
    width_ = std::max({width_, ++used[at(i)], ++used[at(j)]});
  });
  col_.resize(width_ * at(rows_));
  for (std::size_t p = 0; p < col_.size(); ++p) col_[p] = static_cast<std::int32_t>(p / width_);
  exact.value.assign(col_.size(), 0.0);
  std::fill(used.begin(), used.end(), 0);
  for_each_entry([&](std::int32_t i, std::int32_t j, double value) {
    const double scaled = value * exact.root[i] * exact.root[j];
    for (const auto& [row, column] : {std::pair(i, j), std::pair(j, i)}) {
      const std::size_t to = width_ * at(row) + used[at(row)]++;
      col_[to] = column;
      exact.value[to] = scaled;
    }
  });
  root_ = exact.root.cast<float>();
  value_.assign(exact.value.begin(), exact.value.end());
  return exact;
}

/// M W is what is left of sums that cancel, and its inverse is as large as C is ill-conditioned: not in single
/// precision.
void ChebyshevInverse::take_patches(Scaled& exact) {
  const auto count = static_cast<Eigen::Index>(patches());
  const VectorX weight = exact.root.cwiseInverse();
  std::vector<std::int32_t> patch(at(rows_));
  for (Eigen::Index k = 0; k < count; ++k)
    std::fill(patch.begin() + patch_start_[at(k)], patch.begin() + patch_start_[at(k) + 1],
              static_cast<std::int32_t>(k));
  std::vector<Eigen::Triplet<double>> entries;
  for (Eigen::Index i = 0; i < rows_; ++i) {
    entries.emplace_back(i, patch[at(i)], weight[i]);
    for (std::size_t p = width_ * at(i); p < width_ * (at(i) + 1); ++p)
      if (exact.value[p] != 0.0) entries.emplace_back(i, patch[at(col_[p])], exact.value[p] * weight[col_[p]]);
  }
  exact.product.resize(rows_, count);
  exact.product.setFromTriplets(entries.begin(), entries.end());
  Eigen::MatrixXd coarse = Eigen::MatrixXd::Zero(count, count);
  near_.resize(rows_);
  for (Eigen::Index i = 0; i < rows_; ++i) {
    for (Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator it(exact.product, i); it; ++it) {
      const std::int32_t own = patch[at(i)];
      coarse(own, it.col()) += weight[i] * it.value();
      if (it.col() == own) {
        near_[i] = static_cast<float>(it.value());
      } else {
        far_.push_back(
            {static_cast<std::int32_t>(i), static_cast<std::int32_t>(it.col()), static_cast<float>(it.value())});
      }
    }
  }
  exact.coarse.compute(coarse);
  const Eigen::MatrixXd inverse = exact.coarse.solve(Eigen::MatrixXd::Identity(count, count));
  coarse_ = (0.5 * (inverse + inverse.transpose())).cast<float>();
  weight_ = weight.cast<float>();
}

/// Of M without the patches, by Lanczos from a vector that has a part of everything: an estimate from above.
double ChebyshevInverse::smallest_eigenvalue(const Scaled& exact) const {
  const VectorX weight = exact.root.cwiseInverse();
  VectorX sums;
  const auto project = [&](VectorX& v) {  // v -= M Q v
    multiply_patches(weight, v, sums);
    exact.coarse.solveInPlace(sums);
    v.noalias() -= exact.product * sums;
  };
  VectorX v(rows_);
  for (Eigen::Index i = 0; i < rows_; ++i) v[i] = std::sin(1.0 + 12.9898 * static_cast<double>(i));
  project(v);
  v.normalize();
  VectorX next(rows_);
  VectorX before = VectorX::Zero(rows_);
  std::vector<double> alpha;
  std::vector<double> beta{0.0};
  double estimate = std::numeric_limits<double>::infinity();
  for (int k = 1; k <= kLanczosSteps; ++k) {
    for (Eigen::Index i = 0; i < rows_; ++i) {
      next[i] = v[i];
      for (std::size_t p = width_ * at(i); p < width_ * (at(i) + 1); ++p) next[i] += exact.value[p] * v[col_[p]];
    }
    project(next);
    alpha.push_back(v.dot(next));
    next -= alpha.back() * v + beta.back() * before;
    const double length = next.norm();
    const bool exhausted = length < kExhausted;
    if (exhausted || k % kLanczosCheck == 0) {
      const double last = std::exchange(estimate, smallest_of_tridiagonal(alpha, beta));
      if (exhausted || estimate > (1.0 - kLanczosChange) * last) break;
    }
    beta.push_back(length);
    before = v;
    v = next / length;
  }
  return estimate;
}

template <int k>
void ChebyshevInverse::solve_smooth(const SingleLanes<k>& v, WorkOf<k>& work) const {
  multiply_patches(weight_, v, work.coarse);
  solve_coarse<k>(work);
}

template <int k>
void ChebyshevInverse::solve_smooth_of_product(const SingleLanes<k>& v, WorkOf<k>& work) const {
  multiply_patches(near_, v, work.coarse);
  for (const Far& far : far_) work.coarse.row(far.patch) += far.value * v.row(far.row);
  solve_coarse<k>(work);
}

template <int k>
void ChebyshevInverse::add_smooth(const SingleLanes<k>& v, float part, const Patched<k>& coarse,
                                  SingleLanes<k>& to) const {
  to.resize(rows_, k);
  for (std::size_t p = 0; p < patches(); ++p) {
    const Eigen::Array<float, 1, k> scaled = part * coarse.row(static_cast<Eigen::Index>(p));
    for (Eigen::Index i = patch_start_[p]; i < patch_start_[p + 1]; ++i)
      to.row(i).array() = v.row(i).array() + weight_[i] * scaled;
  }
}

template <int k>
void ChebyshevInverse::subtract_product_of_smooth(const Patched<k>& coarse, SingleLanes<k>& v) const {
  for (std::size_t p = 0; p < patches(); ++p) {
    for (Eigen::Index i = patch_start_[p]; i < patch_start_[p + 1]; ++i)
      v.row(i) -= near_[i] * coarse.row(static_cast<Eigen::Index>(p));
  }
  for (const Far& far : far_) v.row(far.row) -= far.value * coarse.row(far.patch);
}

/// x = p(P M) residual, with P M v = M (v - Q M v): without P in every step the smooth part would come back through M.
/// The residual, which P has been applied to, is used up.
template <int k>
void ChebyshevInverse::iterate(WorkOf<k>& work) const {
  using Row = Eigen::Array<float, 1, k>;
  work.step = work.residual / centre_;
  work.x = work.step;
  const float sigma = centre_ / half_width_;
  float rho = 1.0F / sigma;
  for (int n = 1; n < steps_; ++n) {
    solve_smooth_of_product<k>(work.step, work);
    add_smooth<k>(work.step, -1.0F, work.solved, work.without_smooth);
    const float next = 1.0F / (2.0F * sigma - rho);
    const float along = next * rho;
    const float down = 2.0F * next / half_width_;
    parallel_ranges(at(rows_), kGrain / k, [&](std::size_t begin, std::size_t end) {
      const SingleLanes<k>& v = work.without_smooth;
      for (std::size_t row = begin; row < end; ++row) {
        const auto i = static_cast<Eigen::Index>(row);
        Row product = v.row(i);
        for (std::size_t p = width_ * row; p < width_ * (row + 1); ++p) product += value_[p] * v.row(col_[p]).array();
        const Row residual = work.residual.row(i).array() - product;
        const Row step = along * work.step.row(i).array() + down * residual;
        work.residual.row(i) = residual;
        work.step.row(i) = step;
        work.x.row(i).array() += step;
      }
    });
    rho = next;
  }
}

template <int k>
void ChebyshevInverse::apply_lanes(const Lanes<k>& b, Lanes<k>& x, WorkOf<k>& work) const {
  // In the scaled unknowns y = D^1/2 x: M y = c, c = D^-1/2 b.
  work.residual.resize(rows_, k);
  for (Eigen::Index i = 0; i < rows_; ++i)
    work.residual.row(i) = root_[i] * b.row(row_of_[at(i)]).template cast<float>();
  x.resize(rows_, k);
  const auto scale_back = [&](const SingleLanes<k>& y) {
    for (Eigen::Index i = 0; i < rows_; ++i)
      x.row(row_of_[at(i)]) = double{root_[i]} * y.row(i).template cast<double>();
  };
  if (col_.empty()) return scale_back(work.residual);
  solve_smooth<k>(work.residual, work);
  work.first = work.solved;
  subtract_product_of_smooth<k>(work.first, work.residual);  // (I - M Q) c
  iterate<k>(work);
  solve_smooth_of_product<k>(work.x, work);  // (I - Q M), and Q c
  work.first -= work.solved;
  add_smooth<k>(work.x, 1.0F, work.first, work.step);
  scale_back(work.step);
}

template void ChebyshevInverse::apply_lanes<1>(const VectorX&, VectorX&, WorkOf<1>&) const;
template void ChebyshevInverse::apply_lanes<2>(const TwoLanes&, TwoLanes&, WorkOf<2>&) const;
template void ChebyshevInverse::apply_lanes<4>(const FourLanes&, FourLanes&, WorkOf<4>&) const;

std::size_t ChebyshevInverse::memory_bytes() const {
  return sizeof(float) * (value_.capacity() + 3 * at(rows_) + at(coarse_.size())) + sizeof(Far) * far_.capacity() +
         sizeof(std::int32_t) * (col_.capacity() + row_of_.capacity());
}

}  // namespace rhexis::linalg
