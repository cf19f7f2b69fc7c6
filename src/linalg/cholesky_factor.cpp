#include "linalg/cholesky_factor.h"

#include <cholmod.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "base/check.h"
#include "linalg/one_thread.h"
#include "linalg/ordering.h"

namespace rhexis::linalg {
namespace {

CholeskyOutcome outcome_of(int status) {
  if (status == CHOLMOD_OK) return CholeskyOutcome::ok;
  if (status == CHOLMOD_NOT_POSDEF) return CholeskyOutcome::not_positive_definite;
  RHEXIS_CHECK(status == CHOLMOD_OUT_OF_MEMORY || status == CHOLMOD_TOO_LARGE, "CHOLMOD status {}", status);
  return CholeskyOutcome::out_of_memory;
}

}  // namespace

struct CholeskyFactor::Core {
  explicit Core(Ordering with) : ordering(with) {
    cholmod_start(&common);
    common.print = 0;
    common.final_ll = 1;  // so that a simplicial factor, too, stops at a pivot that is not positive
    common.quick_return_if_not_posdef = 1;
#ifdef RHEXIS_CHOLMOD_GPL
    common.supernodal = CHOLMOD_SUPERNODAL;
#else
    common.supernodal = CHOLMOD_SIMPLICIAL;
#endif
  }
  ~Core() {
    clear();
    cholmod_finish(&common);
  }
  Core(const Core&) = delete;
  Core& operator=(const Core&) = delete;

  void clear() {
    cholmod_free_factor(&factor, &common);
    cholmod_free_dense(&x, &common);
    cholmod_free_dense(&y, &common);
    cholmod_free_dense(&e, &common);
  }

  CholeskyOutcome analyse(const UnknownGraph& graph);
  [[nodiscard]] cholmod_factor* analyse_by(const UnknownGraph& graph, Ordering how);

  Ordering ordering;
  bool analysed = false;
  cholmod_common common{};
  cholmod_factor* factor = nullptr;
  cholmod_dense* x = nullptr;  // work space of cholmod_solve2
  cholmod_dense* y = nullptr;
  cholmod_dense* e = nullptr;
  LowerRows rows;
  std::vector<double> values;         // of `rows`
  std::vector<std::uint32_t> source;  // per value, its place in the matrix handed over
  std::vector<std::int32_t> unknown;  // per unknown, its row in the vectors handed over
  std::size_t source_size = 0;        // values of the matrix handed over
  Eigen::Index vector_rows = 0;
  std::vector<double> right;  // right-hand sides over the unknowns
};

cholmod_factor* CholeskyFactor::Core::analyse_by(const UnknownGraph& graph, Ordering how) {
  std::vector<std::int32_t> order = find_order(graph, how);
  if (order.size() != unknown.size()) {
    common.status = CHOLMOD_OUT_OF_MEMORY;
    return nullptr;
  }
  common.nmethods = 1;
  common.method[0].ordering = CHOLMOD_GIVEN;
  cholmod_sparse matrix = cholmod_view(rows, nullptr);
  return cholmod_analyze_p(&matrix, order.data(), nullptr, 0, &common);
}

CholeskyOutcome CholeskyFactor::Core::analyse(const UnknownGraph& graph) {
  clear();
  values.assign(rows.index.size(), 0.0);
  analysed = true;
  if (unknown.empty()) return CholeskyOutcome::ok;
  if (ordering != Ordering::best) {
    factor = analyse_by(graph, ordering);
    return outcome_of(common.status);
  }
  factor = analyse_by(graph, Ordering::amd);
  const double amd_entries = common.lnz;
  const double amd_flops = common.fl;
  cholmod_factor* other = analyse_by(graph, Ordering::metis);
  if (other != nullptr && (factor == nullptr || common.fl < amd_flops)) {
    std::swap(factor, other);
  } else {
    common.lnz = amd_entries;
    common.fl = amd_flops;
  }
  cholmod_free_factor(&other, &common);
  return factor != nullptr ? CholeskyOutcome::ok : outcome_of(common.status);
}

CholeskyFactor::CholeskyFactor(Ordering ordering) : core_(std::make_unique<Core>(ordering)) {}
CholeskyFactor::~CholeskyFactor() = default;
CholeskyFactor::CholeskyFactor(CholeskyFactor&&) noexcept = default;
CholeskyFactor& CholeskyFactor::operator=(CholeskyFactor&&) noexcept = default;

CholeskyOutcome CholeskyFactor::analyse(const BlockPattern& pattern, const FreeDofs& free) {
  RHEXIS_CHECK(free.index.size() == 3 * static_cast<std::size_t>(pattern.rows()), "{} dofs for {} block rows",
               free.index.size(), pattern.rows());
  RHEXIS_CHECK(9 * pattern.block_count() <= std::numeric_limits<std::uint32_t>::max(), "{} blocks",
               pattern.block_count());
  Core& core = *core_;
  core.source_size = 9 * pattern.block_count();
  core.vector_rows = static_cast<Eigen::Index>(free.index.size());
  core.unknown = free.dof;
  core.rows = {};
  core.source.clear();
  for (const std::int32_t dof : free.dof) {
    const auto row = static_cast<std::size_t>(dof / 3);
    const std::int32_t a = dof % 3;
    for (std::int32_t k = pattern.row_start[row]; k < pattern.row_start[row + 1]; ++k) {
      const std::int32_t first = 3 * pattern.column[static_cast<std::size_t>(k)];
      for (std::int32_t b = 0; b < 3 && first + b <= dof; ++b) {
        const std::int32_t other = free.index[static_cast<std::size_t>(first + b)];
        if (other < 0) continue;
        core.rows.index.push_back(other);
        core.source.push_back(9 * static_cast<std::uint32_t>(k) + static_cast<std::uint32_t>(3 * a + b));
      }
    }
    RHEXIS_CHECK(core.rows.index.size() <= std::numeric_limits<std::int32_t>::max(),
                 "more entries than 32 bits can count");
    core.rows.end_row();
  }
  return core.analyse(make_graph(pattern, free));
}

CholeskyOutcome CholeskyFactor::analyse(const CsrPattern& pattern) {
  Core& core = *core_;
  core.source_size = pattern.column.size();
  core.vector_rows = pattern.rows();
  core.unknown.resize(static_cast<std::size_t>(pattern.rows()));
  std::iota(core.unknown.begin(), core.unknown.end(), 0);
  const UnknownGraph graph = make_graph(pattern);
  core.rows = graph.rows;
  core.source.resize(pattern.column.size());
  std::iota(core.source.begin(), core.source.end(), 0U);
  return core.analyse(graph);
}

CholeskyOutcome CholeskyFactor::factor(std::span<const double> values) {
  Core& core = *core_;
  RHEXIS_CHECK(core.analysed, "not analysed");
  RHEXIS_CHECK(values.size() == core.source_size, "{} values for a pattern of {}", values.size(), core.source_size);
  if (core.unknown.empty()) return CholeskyOutcome::ok;
  for (std::size_t i = 0; i < core.source.size(); ++i) core.values[i] = values[core.source[i]];
  stay_on_one_thread();
  cholmod_sparse matrix = cholmod_view(core.rows, core.values.data());
  cholmod_factorize(&matrix, core.factor, &core.common);
  return outcome_of(core.common.status);
}

void CholeskyFactor::solve(const Eigen::Ref<const Eigen::MatrixXd>& b, Eigen::Ref<Eigen::MatrixXd> x) {
  Core& core = *core_;
  RHEXIS_CHECK(b.rows() == core.vector_rows && x.rows() == b.rows() && x.cols() == b.cols(),
               "b {} x {}, x {} x {}, {} rows", b.rows(), b.cols(), x.rows(), x.cols(), core.vector_rows);
  const std::size_t n = core.unknown.size();
  if (n == 0) {
    x.setZero();
    return;
  }
  core.right.resize(n * static_cast<std::size_t>(b.cols()));
  for (Eigen::Index col = 0; col < b.cols(); ++col) {
    double* const to = core.right.data() + n * static_cast<std::size_t>(col);
    for (std::size_t i = 0; i < n; ++i) to[i] = b(core.unknown[i], col);
  }
  stay_on_one_thread();
  cholmod_dense right{};
  right.nrow = right.d = n;
  right.ncol = static_cast<std::size_t>(b.cols());
  right.nzmax = core.right.size();
  right.x = core.right.data();
  right.xtype = CHOLMOD_REAL;
  right.dtype = CHOLMOD_DOUBLE;
  const int done =
      cholmod_solve2(CHOLMOD_A, core.factor, &right, nullptr, &core.x, nullptr, &core.y, &core.e, &core.common);
  RHEXIS_CHECK(done != 0, "CHOLMOD cannot solve: status {}", core.common.status);
  x.setZero();
  for (Eigen::Index col = 0; col < b.cols(); ++col) {
    const double* const from = static_cast<const double*>(core.x->x) + n * static_cast<std::size_t>(col);
    for (std::size_t i = 0; i < n; ++i) x(core.unknown[i], col) = from[i];
  }
}

double CholeskyFactor::smallest_pivot() const {
  const Core& core = *core_;
  double smallest = 1.0;
  if (core.unknown.empty()) return smallest;
  const cholmod_factor& L = *core.factor;
  const auto* const order = static_cast<const std::int32_t*>(L.Perm);
  const auto* const x = static_cast<const double*>(L.x);
  const auto use = [&](std::int32_t column, double pivot) {
    const double diagonal = core.values[static_cast<std::size_t>(core.rows.start[order[column] + 1]) - 1];
    smallest = std::min(smallest, pivot * pivot / diagonal);
  };
  if (L.is_super == 0) {
    const auto* const start = static_cast<const std::int32_t*>(L.p);
    for (std::int32_t column = 0; column < size(); ++column) use(column, x[start[column]]);
    return smallest;
  }
  const auto* const first = static_cast<const std::int32_t*>(L.super);
  const auto* const row_start = static_cast<const std::int32_t*>(L.pi);
  const auto* const value_start = static_cast<const std::int32_t*>(L.px);
  for (std::size_t s = 0; s < L.nsuper; ++s) {
    const std::ptrdiff_t rows = row_start[s + 1] - row_start[s];
    for (std::int32_t i = 0; i < first[s + 1] - first[s]; ++i) use(first[s] + i, x[value_start[s] + i * (rows + 1)]);
  }
  return smallest;
}

std::int32_t CholeskyFactor::size() const { return static_cast<std::int32_t>(core_->unknown.size()); }
double CholeskyFactor::entries() const { return core_->common.lnz; }
double CholeskyFactor::flops() const { return core_->common.fl; }

std::size_t CholeskyFactor::memory_bytes() const {
  const Core& core = *core_;
  return core.common.memory_inuse + sizeof(double) * (core.values.capacity() + core.right.capacity()) +
         sizeof(std::int32_t) * (core.rows.start.capacity() + core.rows.index.capacity() + core.source.capacity() +
                                 core.unknown.capacity());
}

}  // namespace rhexis::linalg
