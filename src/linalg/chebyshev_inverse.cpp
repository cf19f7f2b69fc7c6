#include "linalg/chebyshev_inverse.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Eigenvalues>

#include "base/check.h"
#include "base/parallel.h"
#include "linalg/patches.h"

namespace rhexis::linalg {
namespace {

/// Rows that one thread takes at a time.
constexpr std::size_t kGrain = 8192;
constexpr std::int32_t kPatchSize = 150;
constexpr std::int32_t kMostPatches = 128;
constexpr int kLanczosSteps = 120;
constexpr int kLanczosCheck = 20;  ///< steps after which the estimate is looked at again
constexpr double kLanczosChange = 0.01;
/// Of Lanczos' estimate, which is from above.
constexpr double kSafety = 0.7;

double smallest_of_tridiagonal(const std::vector<double>& diagonal, const std::vector<double>& below) {
  const auto count = static_cast<Eigen::Index>(diagonal.size());
  Eigen::MatrixXd T = Eigen::MatrixXd::Zero(count, count);
  for (Eigen::Index k = 0; k < count; ++k) {
    T(k, k) = diagonal[static_cast<std::size_t>(k)];
    if (k > 0) T(k, k - 1) = T(k - 1, k) = below[static_cast<std::size_t>(k)];
  }
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(T, Eigen::EigenvaluesOnly).eigenvalues()[0];
}

}  // namespace

ChebyshevInverse::ChebyshevInverse(const SymmetricCsr& C, double reduction) : rows_(C.rows()), root_(C.rows()) {
  const CsrPattern& pattern = *C.pattern;
  const auto at = [](Eigen::Index i) { return static_cast<std::size_t>(i); };
  for (Eigen::Index i = 0; i < rows_; ++i) {
    const double diagonal = C.values[at(pattern.row_start[at(i) + 1]) - 1];
    RHEXIS_CHECK(diagonal > 0.0, "diagonal {} in row {}", diagonal, i);
    root_[i] = 1.0 / std::sqrt(diagonal);
  }
  start_.assign(at(rows_) + 1, 0);
  const auto for_each_entry = [&](const auto& use) {
    for (Eigen::Index i = 0; i < rows_; ++i) {
      for (std::int32_t k = pattern.row_start[at(i)]; k + 1 < pattern.row_start[at(i) + 1]; ++k)
        use(static_cast<std::int32_t>(i), pattern.column[at(k)], C.values[at(k)]);
    }
  };
  for_each_entry([&](std::int32_t i, std::int32_t j, double) {
    ++start_[at(i) + 1];
    ++start_[at(j) + 1];
  });
  for (std::size_t i = 1; i < start_.size(); ++i) start_[i] += start_[i - 1];
  col_.resize(at(start_.back()));
  value_.resize(col_.size());
  std::vector<std::int32_t> next(start_.begin(), start_.end() - 1);
  VectorX off = VectorX::Zero(rows_);
  for_each_entry([&](std::int32_t i, std::int32_t j, double value) {
    const double scaled = value * root_[i] * root_[j];
    for (const auto& [row, column] : {std::pair(i, j), std::pair(j, i)}) {
      const auto place = at(next[at(row)]++);
      col_[place] = column;
      value_[place] = scaled;
    }
    // Gershgorin's circles of D^-1 C, which has the same eigenvalues.
    off[i] += std::abs(value) * root_[i] * root_[i];
    off[j] += std::abs(value) * root_[j] * root_[j];
  });
  const double radius = rows_ == 0 ? 0.0 : off.maxCoeff();
  RHEXIS_CHECK(radius < 1.0, "not diagonally dominant: {}", radius);
  if (radius == 0.0) return;

  patch_ = cut_into_patches(pattern, std::max(kPatchSize, static_cast<std::int32_t>((rows_ - 1) / kMostPatches + 1)));
  const std::int32_t count = *std::max_element(patch_.begin(), patch_.end()) + 1;
  weight_ = root_.cwiseInverse();
  std::vector<Eigen::Triplet<double>> entries;
  for (Eigen::Index i = 0; i < rows_; ++i) {
    entries.emplace_back(i, patch_[at(i)], weight_[i]);
    for (std::int32_t p = start_[at(i)]; p < start_[at(i) + 1]; ++p)
      entries.emplace_back(i, patch_[at(col_[at(p)])], value_[at(p)] * weight_[col_[at(p)]]);
  }
  product_.resize(rows_, count);
  product_.setFromTriplets(entries.begin(), entries.end());
  Eigen::MatrixXd coarse = Eigen::MatrixXd::Zero(count, count);
  for (Eigen::Index i = 0; i < rows_; ++i) {
    for (Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator it(product_, i); it; ++it)
      coarse(patch_[at(i)], it.col()) += weight_[i] * it.value();
  }
  coarse_.compute(coarse);

  const double high = 1.0 + radius;
  const double low = std::max(1.0 - radius, kSafety * smallest_eigenvalue());
  centre_ = 0.5 * (high + low);
  half_width_ = 0.5 * (high - low);
  // Error after k steps: at most 1 / T_k(centre / half width).
  steps_ = std::max(1, static_cast<int>(std::ceil(std::acosh(1.0 / reduction) / std::acosh(centre_ / half_width_))));
}

void ChebyshevInverse::multiply(const VectorX& x, VectorX& y) const {
  y.resize(rows_);
  parallel_ranges(static_cast<std::size_t>(rows_), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      double sum = x[static_cast<Eigen::Index>(i)];
      for (std::int32_t p = start_[i]; p < start_[i + 1]; ++p)
        sum += value_[static_cast<std::size_t>(p)] * x[col_[static_cast<std::size_t>(p)]];
      y[static_cast<Eigen::Index>(i)] = sum;
    }
  });
}

void ChebyshevInverse::project(VectorX& v, VectorX& coarse) const {
  coarse.setZero(product_.cols());
  for (Eigen::Index i = 0; i < rows_; ++i) coarse[patch_[static_cast<std::size_t>(i)]] += weight_[i] * v[i];
  coarse_.solveInPlace(coarse);
  v.noalias() -= product_ * coarse;
}

void ChebyshevInverse::project_transposed(VectorX& v, VectorX& coarse) const {
  coarse.noalias() = product_.transpose() * v;
  coarse_.solveInPlace(coarse);
  for (Eigen::Index i = 0; i < rows_; ++i) v[i] -= weight_[i] * coarse[patch_[static_cast<std::size_t>(i)]];
}

/// Of M without the patches, by Lanczos from a vector that has a part of everything: an estimate from above.
double ChebyshevInverse::smallest_eigenvalue() const {
  VectorX v(rows_);
  for (Eigen::Index i = 0; i < rows_; ++i) v[i] = std::sin(1.0 + 12.9898 * static_cast<double>(i));
  VectorX coarse;
  VectorX next(rows_);
  VectorX before = VectorX::Zero(rows_);
  project(v, coarse);
  std::vector<double> alpha;
  std::vector<double> beta{0.0};
  double estimate = std::numeric_limits<double>::infinity();
  v.normalize();
  for (int k = 1; k <= kLanczosSteps; ++k) {
    multiply(v, next);
    project(next, coarse);
    alpha.push_back(v.dot(next));
    next -= alpha.back() * v + beta.back() * before;
    const double length = next.norm();
    const bool exhausted = length < 1e-8;
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

/// x = p(P M) residual, P = I - M Q: without P in every step the smooth part would come back through M. The residual,
/// which P has been applied to, is used up.
void ChebyshevInverse::iterate(VectorX& x, Work& work) const {
  VectorX& residual = work.residual;
  VectorX& step = work.step;
  step = residual / centre_;
  x = step;
  const double sigma = centre_ / half_width_;
  double rho = 1.0 / sigma;
  for (int k = 1; k < steps_; ++k) {
    multiply(step, work.product);
    project(work.product, work.coarse);
    residual -= work.product;
    const double next = 1.0 / (2.0 * sigma - rho);
    step = (next * rho) * step + (2.0 * next / half_width_) * residual;
    x += step;
    rho = next;
  }
}

void ChebyshevInverse::apply(const VectorX& b, VectorX& x, Work& work) const {
  // In the scaled unknowns y = D^1/2 x: M y = c, c = D^-1/2 b.
  VectorX& c = work.residual;
  c = root_.cwiseProduct(b);
  if (patch_.empty()) {
    x = root_.cwiseProduct(c);
    return;
  }
  VectorX& coarse = work.exact;
  coarse.setZero(product_.cols());
  for (Eigen::Index i = 0; i < rows_; ++i) coarse[patch_[static_cast<std::size_t>(i)]] += weight_[i] * c[i];
  coarse_.solveInPlace(coarse);
  c.noalias() -= product_ * coarse;  // (I - M Q) c
  iterate(x, work);
  project_transposed(x, work.coarse);
  for (Eigen::Index i = 0; i < rows_; ++i) x[i] += weight_[i] * coarse[patch_[static_cast<std::size_t>(i)]];
  x = root_.cwiseProduct(x);
}

std::size_t ChebyshevInverse::memory_bytes() const {
  return sizeof(double) * (value_.capacity() + static_cast<std::size_t>(root_.size())) +
         sizeof(std::int32_t) * (start_.capacity() + col_.capacity());
}

}  // namespace rhexis::linalg
