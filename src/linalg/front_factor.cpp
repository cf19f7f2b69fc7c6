#include "linalg/front_factor.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "base/parallel.h"
#include "linalg/front_kernels.h"

namespace rhexis::linalg {
namespace {

// Columns whose effect on the rest of the panel is taken at once: a power of two times the width of the kernel, wide
// enough that the rest is read and written seldom.
constexpr int kStripe = 4 * kFactorWidth;
// Operations of a front below which it is done before a thread has come.
constexpr double kForkFrom = 5e7;
// Rows of a stripe that are solved for at once.
constexpr int kRows = 512;

void for_each(bool may_fork, int count, const std::function<void(std::size_t)>& body) {
  if (may_fork) {
    parallel_for(static_cast<std::size_t>(count), body);
  } else {
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) body(i);
  }
}

/// L_pp, L_bp and y, stripe by stripe. What is worked on at once depends on sizes alone, and so do the bits.
bool factor_panel(Front& front, bool may_fork) {
  const FrontKernels& kernels = front_kernels();
  const int ld = front.ld();
  const auto at = [&](int row, int column) {
    return front.panel.get() + static_cast<std::ptrdiff_t>(column) * ld + row;
  };
  std::vector<double> inverse(kStripe * kFactorWidth);
  const Block work = make_block(static_cast<std::size_t>(ld) * kFactorWidth);
  for (int first = 0; first < front.pivots; first += kStripe) {
    const int columns = std::min(kStripe, front.pivots - first);
    if (!kernels.factor(at(first, first), columns, ld, inverse.data(), work.get())) return false;
    const int next = first + columns;
    for_each(may_fork, (ld - next + kRows - 1) / kRows, [&](std::size_t block) {
      const int row = next + static_cast<int>(block) * kRows;
      kernels.solve_rows(at(row, first), std::min(kRows, ld - row), at(first, first), inverse.data(), columns, ld,
                         work.get() + static_cast<std::ptrdiff_t>(row) * kFactorWidth);
    });
    const int width = block_width(front.pivots - next);
    for_each(may_fork, (front.pivots - next + width - 1) / width, [&](std::size_t block) {
      const int j = next + static_cast<int>(block) * width;
      kernels.subtract_lower(at(j, j), ld, at(j, first), ld, ld - j, std::min(width, front.pivots - j), columns);
    });
  }
  return true;
}

}  // namespace

void eliminate_pivots(Front& front, std::span<const double> diagonal, double null_pivot) {
  const double p = front.pivots;
  const double b = front.boundary() + 1;
  front.flops = p * p * p / 3.0 + p * p * b + p * b * b;
  if (front.pivots == 0) return;
  const bool may_fork = front.flops > kForkFrom;
  front.positive_definite = factor_panel(front, may_fork);
  for (std::int32_t j = 0; j < front.pivots && front.positive_definite; ++j) {
    const double L = front.panel[static_cast<std::size_t>(j) * static_cast<std::size_t>(front.ld() + 1)];
    // Also false for what is not a number.
    front.positive_definite = L * L > null_pivot * diagonal[static_cast<std::size_t>(j)] && std::isfinite(L);
  }
  if (!front.positive_definite) return;
  LowerTriangle& U = front.update;
  for_each(may_fork, U.blocks(), [&](std::size_t block) {
    const int k = static_cast<int>(block);
    const double* const L = front.panel.get() + front.pivots + U.first_column(k);
    front_kernels().subtract_lower(U.block(k), U.rows(k), L, front.ld(), U.rows(k), U.columns(k), front.pivots);
  });
}

}  // namespace rhexis::linalg
