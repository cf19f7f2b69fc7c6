#include "record/build/operator_factor.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/check.h"
#include "linalg/null_pivot.h"
#include "linalg/ordering.h"

namespace rhexis::record::build {
namespace {

std::size_t at(std::int64_t i) { return static_cast<std::size_t>(i); }

/// The pattern of L for an order of the unknowns: a column takes what the matrix has there, and the columns of its
/// children in the elimination tree.
store::OperatorPattern fill_in(const linalg::UnknownGraph& graph, const linalg::FreeDofs& free,
                               const std::vector<std::int32_t>& order) {
  const auto n = static_cast<std::int32_t>(order.size());
  std::vector<std::int32_t> place(order.size());
  for (std::int32_t i = 0; i < n; ++i) place[at(order[at(i)])] = i;
  std::vector<std::vector<std::int32_t>> column(order.size());
  const auto& [rows, unknown_start] = graph;
  for (std::size_t v = 0; v + 1 < unknown_start.size(); ++v) {
    for (std::int32_t e = rows.start[v]; e < rows.start[v + 1]; ++e) {
      const std::size_t w = at(rows.index[at(e)]);
      for (std::int32_t a = unknown_start[v]; a < unknown_start[v + 1]; ++a) {
        for (std::int32_t b = unknown_start[w]; b < unknown_start[w + 1]; ++b) {
          const auto [low, high] = std::minmax(place[at(a)], place[at(b)]);
          column[at(low)].push_back(high);
        }
      }
    }
  }
  store::OperatorPattern out;
  out.start = {0};
  for (std::int32_t j = 0; j < n; ++j) {
    std::vector<std::int32_t>& rows_here = column[at(j)];
    std::sort(rows_here.begin(), rows_here.end());
    rows_here.erase(std::unique(rows_here.begin(), rows_here.end()), rows_here.end());
    out.dof.push_back(free.dof[at(order[at(j)])]);
    out.row.insert(out.row.end(), rows_here.begin(), rows_here.end());
    out.start.push_back(static_cast<std::int64_t>(out.row.size()));
    if (rows_here.size() > 1) {
      std::vector<std::int32_t>& parent = column[at(rows_here[1])];
      parent.insert(parent.end(), rows_here.begin() + 1, rows_here.end());
    }
    rows_here = {};
  }
  return out;
}

}  // namespace

OperatorLayout::OperatorLayout(const linalg::BlockPattern& pattern, const linalg::FreeDofs& free) {
  const linalg::UnknownGraph graph = linalg::make_graph(pattern, free);
  for (const linalg::Ordering how : {linalg::Ordering::metis, linalg::Ordering::amd}) {
    store::OperatorPattern filled = fill_in(graph, free, linalg::find_order(graph, how));
    if (pattern_.row.empty() || filled.entries() < pattern_.entries()) pattern_ = std::move(filled);
  }
  row_of_.assign(free.index.size(), -1);
  row_start_.assign(at(pattern_.rows()) + 1, 0);
  for (std::int32_t j = 0; j < pattern_.rows(); ++j) {
    row_of_[at(pattern_.dof[at(j)])] = j;
    for (std::int64_t p = pattern_.start[at(j)] + 1; p < pattern_.start[at(j) + 1]; ++p)
      ++row_start_[at(pattern_.row[at(p)]) + 1];
  }
  for (std::size_t i = 1; i < row_start_.size(); ++i) row_start_[i] += row_start_[i - 1];
  row_entries_.resize(at(row_start_.back()));
  std::vector<std::int64_t> next(row_start_.begin(), row_start_.end() - 1);
  for (std::int32_t j = 0; j < pattern_.rows(); ++j) {
    for (std::int64_t p = pattern_.start[at(j)] + 1; p < pattern_.start[at(j) + 1]; ++p)
      row_entries_[at(next[at(pattern_.row[at(p)])]++)] = {j, p};
  }
}

std::int64_t OperatorLayout::entry(std::int32_t row, std::int32_t column) const {
  const auto begin = pattern_.row.begin() + pattern_.start[at(column)];
  const auto end = pattern_.row.begin() + pattern_.start[at(column) + 1];
  const auto found = std::lower_bound(begin, end, row);
  return found != end && *found == row ? found - pattern_.row.begin() : -1;
}

std::span<const OperatorLayout::RowEntry> OperatorLayout::row_entries(std::int32_t row) const {
  return std::span(row_entries_).subspan(at(row_start_[at(row)]), at(row_start_[at(row) + 1] - row_start_[at(row)]));
}

OperatorFactor::OperatorFactor(const OperatorLayout& layout)
    : layout_(&layout),
      stiffness_(layout.pattern().entries(), std::nan("")),  // which differs from everything
      values_(layout.pattern().entries(), 0.0) {}

bool OperatorFactor::update(const std::vector<double>& stiffness) {
  const store::OperatorPattern& L = layout_->pattern();
  RHEXIS_CHECK(stiffness.size() == values_.size(), "{} values for {} entries", stiffness.size(), values_.size());
  const double null_pivot = linalg::null_pivot(L.rows());
  std::vector<char> changed(at(L.rows()), 0);
  std::vector<double> w(at(L.rows()), 0.0);
  columns_made_ = 0;
  for (std::int32_t j = 0; j < L.rows(); ++j) {
    const std::int64_t begin = L.start[at(j)];
    const std::int64_t end = L.start[at(j) + 1];
    if (changed[at(j)] == 0 &&
        std::equal(stiffness.begin() + begin, stiffness.begin() + end, stiffness_.begin() + begin))
      continue;
    ++columns_made_;
    if (end - begin > 1) changed[at(L.row[at(begin + 1)])] = 1;  // its parent in the elimination tree
    for (std::int64_t p = begin; p < end; ++p) w[at(L.row[at(p)])] = stiffness[at(p)];
    for (const auto& [column, entry] : layout_->row_entries(j)) {
      const double l = values_[at(entry)];
      if (l == 0.0) continue;
      for (std::int64_t p = entry; p < L.start[at(column) + 1]; ++p) w[at(L.row[at(p)])] -= l * values_[at(p)];
    }
    const double pivot = w[at(j)];
    if (!(pivot > null_pivot * stiffness[at(begin)])) return false;
    const double root = std::sqrt(pivot);
    values_[at(begin)] = root;
    for (std::int64_t p = begin + 1; p < end; ++p) values_[at(p)] = w[at(L.row[at(p)])] / root;
  }
  stiffness_ = stiffness;
  return true;
}

/// Z = K^-1 solves Z L = L^-T: from the last column on, those of a column follow from the ones right of it,
/// Z_ij = -(1 / L_jj) sum over k > j of Z_ik L_kj, where Z_ik is in the pattern whenever L_ij and L_kj are.
std::vector<double> OperatorFactor::selected_inverse() const {
  const store::OperatorPattern& L = layout_->pattern();
  std::vector<double> Z(values_.size(), 0.0);
  std::vector<double> l(at(L.rows()), 0.0);
  std::vector<double> sum(at(L.rows()), 0.0);
  std::vector<char> in_column(at(L.rows()), 0);
  for (std::int32_t j = L.rows() - 1; j >= 0; --j) {
    const std::int64_t begin = L.start[at(j)];
    const std::int64_t end = L.start[at(j) + 1];
    for (std::int64_t p = begin + 1; p < end; ++p) {
      l[at(L.row[at(p)])] = values_[at(p)];
      in_column[at(L.row[at(p)])] = 1;
    }
    for (std::int64_t p = begin + 1; p < end; ++p) {
      const std::size_t k = at(L.row[at(p)]);
      double own = Z[at(L.start[k])] * l[k];
      for (std::int64_t s = L.start[k] + 1; s < L.start[k + 1]; ++s) {
        const std::size_t i = at(L.row[at(s)]);
        if (in_column[i] == 0) continue;
        sum[i] += Z[at(s)] * l[k];
        own += Z[at(s)] * l[i];
      }
      sum[k] += own;
    }
    const double diagonal = values_[at(begin)];
    double dot = 0.0;
    for (std::int64_t p = begin + 1; p < end; ++p) {
      const std::size_t i = at(L.row[at(p)]);
      Z[at(p)] = -sum[i] / diagonal;
      dot += l[i] * Z[at(p)];
      sum[i] = 0.0;
      l[i] = 0.0;
      in_column[i] = 0;
    }
    Z[at(begin)] = (1.0 / diagonal - dot) / diagonal;
  }
  return Z;
}

}  // namespace rhexis::record::build
