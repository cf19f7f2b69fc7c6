#include "linalg/whole_rows.h"

#include <utility>

#include "base/check.h"
#include "base/parallel.h"

namespace rhexis::linalg {
namespace {

/// Block rows handed to a thread at once.
constexpr std::size_t kRowGrain = 4096;

std::size_t at(std::int32_t i) { return static_cast<std::size_t>(i); }

}  // namespace

void WholeRows::take_pattern(std::shared_ptr<const BlockPattern> pattern) {
  pattern_ = std::move(pattern);
  const BlockPattern& p = *pattern_;
  start_.assign(1, 0);
  column_.clear();
  source_.clear();
  for (std::int32_t row = 0; row < p.rows(); ++row) {
    for (std::int32_t i = p.row_start[at(row)]; i < p.row_start[at(row) + 1]; ++i) {
      column_.push_back(p.column[at(i)]);
      source_.push_back(i);
    }
    for (std::int32_t i = p.below_start[at(row)]; i < p.below_start[at(row) + 1]; ++i) {
      column_.push_back(p.below_row[at(i)]);
      source_.push_back(~p.below_block[at(i)]);
    }
    start_.push_back(static_cast<std::int32_t>(column_.size()));
  }
  values_.resize(9 * column_.size());
}

void WholeRows::take(const SymmetricBlockMatrix& A) {
  if (A.pattern != pattern_) take_pattern(A.pattern);
  using Given = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>;
  using Kept = Eigen::Map<Eigen::Matrix<float, 3, 3, Eigen::RowMajor>>;
  parallel_ranges(source_.size(), 8 * kRowGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Kept to(values_.data() + 9 * i);
      const std::int32_t block = source_[i];
      if (block >= 0) {
        to = Given(A.values.data() + 9 * at(block)).cast<float>();
      } else {
        to = Given(A.values.data() + 9 * at(~block)).transpose().cast<float>();
      }
    }
  });
}

template <int k>
void WholeRows::multiply(const Lanes<k>& x, Lanes<k>& y) const {
  const std::size_t rows = start_.size() - 1;
  RHEXIS_CHECK(x.rows() == static_cast<Eigen::Index>(3 * rows), "{} rows, x {}", rows, x.rows());
  y.resize(x.rows(), k);
  using Row = Eigen::Array<double, k, 1>;
  using Given = Eigen::Map<const Row>;
  parallel_ranges(rows, kRowGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) {
      Row y0 = Row::Zero();
      Row y1 = Row::Zero();
      Row y2 = Row::Zero();
      for (std::size_t i = at(start_[row]); i < at(start_[row + 1]); ++i) {
        const Eigen::Array<double, 9, 1> a =
            Eigen::Map<const Eigen::Array<float, 9, 1>>(values_.data() + 9 * i).template cast<double>();
        const double* const v = x.data() + 3 * k * at(column_[i]);
        const Given v0(v);
        const Given v1(v + k);
        const Given v2(v + 2 * k);
        y0 += a[0] * v0 + a[1] * v1 + a[2] * v2;
        y1 += a[3] * v0 + a[4] * v1 + a[5] * v2;
        y2 += a[6] * v0 + a[7] * v1 + a[8] * v2;
      }
      Eigen::Map<Eigen::Array<double, k, 3, k == 1 ? Eigen::RowMajor : Eigen::ColMajor>> to(y.data() + 3 * k * row);
      to.col(0) = y0;
      to.col(1) = y1;
      to.col(2) = y2;
    }
  });
}
template void WholeRows::multiply<1>(const VectorX&, VectorX&) const;
template void WholeRows::multiply<2>(const TwoLanes&, TwoLanes&) const;
template void WholeRows::multiply<4>(const FourLanes&, FourLanes&) const;

std::size_t WholeRows::memory_bytes() const {
  return sizeof(float) * values_.capacity() +
         sizeof(std::int32_t) * (start_.capacity() + column_.capacity() + source_.capacity());
}

}  // namespace rhexis::linalg
