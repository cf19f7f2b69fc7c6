#include "linalg/block_matrix.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <utility>

#include "base/check.h"
#include "base/parallel.h"

namespace rhexis::linalg {
namespace {

/// Rows handed to a thread at once. Below that the work is too small to be shared.
constexpr std::size_t kRowGrain = 2048;

/// Columns below the diagonal, bucketed by row, with the repetitions of shared edges.
struct Buckets {
  std::vector<std::size_t> start;
  std::vector<std::int32_t> column;
};

Buckets bucket_pairs(std::int32_t rows, std::span<const std::int32_t> connectivity, std::size_t per_element) {
  Buckets out;
  out.start.assign(static_cast<std::size_t>(rows) + 1, 0);
  const auto for_each_pair = [&](const auto& use) {
    for (std::size_t first = 0; first < connectivity.size(); first += per_element) {
      for (std::size_t a = first; a < first + per_element; ++a) {
        for (std::size_t b = first; b < a; ++b) {
          const auto [low, high] = std::minmax(connectivity[a], connectivity[b]);
          if (low != high) use(static_cast<std::size_t>(high), low);
        }
      }
    }
  };
  for_each_pair([&](std::size_t row, std::int32_t) { ++out.start[row + 1]; });
  for (std::size_t row = 1; row < out.start.size(); ++row) out.start[row] += out.start[row - 1];
  out.column.resize(out.start.back());
  std::vector<std::size_t> next(out.start.begin(), out.start.end() - 1);
  for_each_pair([&](std::size_t row, std::int32_t col) { out.column[next[row]++] = col; });
  return out;
}

void index_by_column(BlockPattern& pattern) {
  const auto rows = static_cast<std::size_t>(pattern.rows());
  pattern.below_start.assign(rows + 1, 0);
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::int32_t k = pattern.row_start[row]; k + 1 < pattern.row_start[row + 1]; ++k) {
      ++pattern.below_start[static_cast<std::size_t>(pattern.column[static_cast<std::size_t>(k)]) + 1];
    }
  }
  for (std::size_t col = 0; col < rows; ++col) pattern.below_start[col + 1] += pattern.below_start[col];
  pattern.below_row.resize(static_cast<std::size_t>(pattern.below_start.back()));
  pattern.below_block.resize(pattern.below_row.size());
  std::vector<std::int32_t> next(pattern.below_start.begin(), pattern.below_start.end() - 1);
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::int32_t k = pattern.row_start[row]; k + 1 < pattern.row_start[row + 1]; ++k) {
      const auto col = static_cast<std::size_t>(pattern.column[static_cast<std::size_t>(k)]);
      const auto at = static_cast<std::size_t>(next[col]++);
      pattern.below_row[at] = static_cast<std::int32_t>(row);
      pattern.below_block[at] = k;
    }
  }
}

}  // namespace

std::int32_t BlockPattern::find(std::int32_t row, std::int32_t col) const {
  const auto first = column.begin() + row_start[static_cast<std::size_t>(row)];
  const auto last = column.begin() + row_start[static_cast<std::size_t>(row) + 1];
  const auto at = std::lower_bound(first, last, col);
  return at != last && *at == col ? static_cast<std::int32_t>(at - column.begin()) : -1;
}

BlockPattern make_block_pattern(std::int32_t rows, std::span<const std::int32_t> connectivity,
                                std::int32_t nodes_per_element) {
  RHEXIS_CHECK(rows >= 0, "{} rows", rows);
  RHEXIS_CHECK(nodes_per_element > 0 && connectivity.size() % static_cast<std::size_t>(nodes_per_element) == 0,
               "{} nodes do not make elements of {}", connectivity.size(), nodes_per_element);
  for (const std::int32_t node : connectivity) {
    RHEXIS_CHECK(node >= 0 && node < rows, "node {} outside [0, {})", node, rows);
  }

  Buckets pairs = bucket_pairs(rows, connectivity, static_cast<std::size_t>(nodes_per_element));
  std::vector<std::size_t> unique_count(static_cast<std::size_t>(rows));
  parallel_ranges(unique_count.size(), kRowGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) {
      const auto first = pairs.column.begin() + static_cast<std::ptrdiff_t>(pairs.start[row]);
      const auto last = pairs.column.begin() + static_cast<std::ptrdiff_t>(pairs.start[row + 1]);
      std::sort(first, last);
      unique_count[row] = static_cast<std::size_t>(std::unique(first, last) - first);
    }
  });

  BlockPattern pattern;
  pattern.row_start.resize(unique_count.size() + 1, 0);
  std::size_t total = 0;
  for (std::size_t row = 0; row < unique_count.size(); ++row) {
    total += unique_count[row] + 1;
    RHEXIS_CHECK(total <= std::numeric_limits<std::int32_t>::max(), "more blocks than 32 bits can count");
    pattern.row_start[row + 1] = static_cast<std::int32_t>(total);
  }
  pattern.column.resize(total);
  for (std::size_t row = 0; row < unique_count.size(); ++row) {
    auto at = std::copy_n(pairs.column.begin() + static_cast<std::ptrdiff_t>(pairs.start[row]), unique_count[row],
                          pattern.column.begin() + pattern.row_start[row]);
    *at = static_cast<std::int32_t>(row);
  }
  index_by_column(pattern);
  return pattern;
}

SymmetricBlockMatrix::SymmetricBlockMatrix(std::shared_ptr<const BlockPattern> of) : pattern(std::move(of)) {
  values.assign(9 * pattern->block_count(), 0.0);
}

void SymmetricBlockMatrix::set_zero() { std::fill(values.begin(), values.end(), 0.0); }

template <int k>
void SymmetricBlockMatrix::multiply(const Lanes<k>& x, Lanes<k>& y) const {
  RHEXIS_CHECK(x.rows() == 3 * rows() && y.rows() == x.rows(), "{} rows, x {}, y {}", rows(), x.rows(), y.rows());
  using Row = Eigen::Array<double, k, 1>;
  using Given = Eigen::Map<const Row>;
  const auto multiply_rows = [&](std::size_t begin, std::size_t end) {
    const BlockPattern& p = *pattern;
    const auto given = [from = x.data()](std::int32_t node) { return from + 3 * k * static_cast<std::size_t>(node); };
    for (std::size_t row = begin; row < end; ++row) {
      Row y0 = Row::Zero();
      Row y1 = Row::Zero();
      Row y2 = Row::Zero();
      for (std::int32_t i = p.row_start[row]; i < p.row_start[row + 1]; ++i) {
        const double* const a = values.data() + 9 * static_cast<std::size_t>(i);
        const double* const v = given(p.column[static_cast<std::size_t>(i)]);
        const Given v0(v);
        const Given v1(v + k);
        const Given v2(v + 2 * k);
        y0 += a[0] * v0 + a[1] * v1 + a[2] * v2;
        y1 += a[3] * v0 + a[4] * v1 + a[5] * v2;
        y2 += a[6] * v0 + a[7] * v1 + a[8] * v2;
      }
      for (auto i = static_cast<std::size_t>(p.below_start[row]); i < static_cast<std::size_t>(p.below_start[row + 1]);
           ++i) {
        const double* const a = values.data() + 9 * static_cast<std::size_t>(p.below_block[i]);
        const double* const v = given(p.below_row[i]);
        const Given v0(v);
        const Given v1(v + k);
        const Given v2(v + 2 * k);
        y0 += a[0] * v0 + a[3] * v1 + a[6] * v2;
        y1 += a[1] * v0 + a[4] * v1 + a[7] * v2;
        y2 += a[2] * v0 + a[5] * v1 + a[8] * v2;
      }
      Eigen::Map<Eigen::Array<double, k, 3, k == 1 ? Eigen::RowMajor : Eigen::ColMajor>> to(y.data() + 3 * k * row);
      to.col(0) = y0;
      to.col(1) = y1;
      to.col(2) = y2;
    }
  };
  const auto count = static_cast<std::size_t>(rows());
  if (count <= kRowGrain) {
    multiply_rows(0, count);
  } else {
    parallel_ranges(count, kRowGrain, std::ref(multiply_rows));
  }
}

void SymmetricBlockMatrix::multiply(const VectorX& x, VectorX& y) const { multiply<1>(x, y); }
template void SymmetricBlockMatrix::multiply<2>(const TwoLanes&, TwoLanes&) const;
template void SymmetricBlockMatrix::multiply<4>(const FourLanes&, FourLanes&) const;

}  // namespace rhexis::linalg
