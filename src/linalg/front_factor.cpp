#include "linalg/front_factor.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "base/parallel.h"
#include "linalg/front_kernels.h"

namespace rhexis::linalg {
namespace {

// Columns that are factored on one thread before the rest of the panel takes their effect on several: a power of two
// times the width of the kernel, wide enough that the rest is read and written seldom.
constexpr int kStripe = 4 * kFactorWidth;
constexpr int kBlock = LowerTriangle::kBlock;

void for_each(bool may_fork, int count, const std::function<void(std::size_t)>& body) {
  if (may_fork) {
    parallel_for(static_cast<std::size_t>(count), body);
  } else {
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) body(i);
  }
}

/// L_pp, L_bp and y, stripe by stripe.
bool factor_panel(Front& front, bool may_fork) {
  const FrontKernels& kernels = front_kernels();
  const int rows = front.ld();
  const auto at = [&](int row, int column) {
    return front.panel.get() + static_cast<std::ptrdiff_t>(column) * rows + row;
  };
  std::vector<double> work(static_cast<std::size_t>(rows) * kFactorWidth);
  for (int first = 0; first < front.pivots; first += kStripe) {
    const int columns = std::min(kStripe, front.pivots - first);
    if (!kernels.factor(at(first, first), rows - first, columns, rows, work.data())) return false;
    const int next = first + columns;
    for_each(may_fork, (front.pivots - next + kBlock - 1) / kBlock, [&](std::size_t block) {
      const int j = next + static_cast<int>(block) * kBlock;
      kernels.subtract_product(at(j, j), rows, at(j, first), at(j, first), rows, rows - j,
                               std::min(kBlock, front.pivots - j), columns);
    });
  }
  return true;
}

}  // namespace

void eliminate_pivots(Front& front, std::span<const double> diagonal, double null_pivot, bool may_fork) {
  const double p = front.pivots;
  const double b = front.boundary() + 1;
  front.flops = p * p * p / 3.0 + p * p * b + p * b * b;
  if (front.pivots == 0) return;
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
    const double* const L = front.panel.get() + front.pivots + LowerTriangle::first_column(k);
    front_kernels().subtract_product(U.block(k), U.rows(k), L, L, front.ld(), U.rows(k), U.columns(k), front.pivots);
  });
}

}  // namespace rhexis::linalg
