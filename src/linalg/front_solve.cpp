// Forward and backward substitution with the fronts of one version.

#include <algorithm>
#include <map>

#include "base/check.h"
#include "base/parallel.h"
#include "linalg/front_core.h"
#include "linalg/front_kernels.h"

namespace rhexis::linalg {
namespace {

std::size_t at(std::int32_t i) { return static_cast<std::size_t>(i); }

/// Fronts of a level that one thread takes at a time.
constexpr std::size_t kLevelGrain = 16;

/// y of the loads, as it stands in the panel's last row.
Eigen::Map<const VectorX, 0, Eigen::InnerStride<>> load_solution(const Front& front) {
  return {front.panel.get() + front.size(), front.pivots, Eigen::InnerStride<>(front.ld())};
}

}  // namespace

/// Backward substitution of one version.
class FrontTree::Core::Backward {
 public:
  Backward(const Core& core, const Forward* forward, const VectorX& amount, double load_amount, VectorX& x)
      : core_(core), amount_(amount), load_amount_(load_amount), x_(x), y_(core.fronts.size(), nullptr) {
    if (forward == nullptr) return;
    for (std::size_t i = 0; i < forward->front.size(); ++i) y_[at(forward->front[i])] = &forward->y[i];
  }

  /// Everything after it has been solved for. `work` grows as needed.
  void solve(std::int32_t component, VectorX& work) const {
    const Front& front = *core_.front(component);
    const std::int32_t pivots = front.pivots;
    if (pivots == 0) return;
    if (work.size() < front.size()) work.resize(front.size());
    for (std::int32_t k = pivots; k < front.size(); ++k) work[k] = x_[front.dofs[at(k)]];
    work.head(pivots) = load_amount_ * load_solution(front);
    if (const Eigen::MatrixXd* const own = y_[at(component)]) work.head(pivots).noalias() += *own * amount_;
    front_kernels().backward(front.panel.get(), front.ld(), pivots, front.boundary(), work.data());
    for (std::int32_t k = 0; k < pivots; ++k) x_[front.dofs[at(k)]] = work[k];
  }

 private:
  const Core& core_;
  const VectorX& amount_;
  double load_amount_;
  VectorX& x_;
  std::vector<const Eigen::MatrixXd*> y_;  // per component
};

FrontTree::Forward FrontTree::forward(std::span<const std::int32_t> dof, const Eigen::MatrixXd& rows) const {
  const Core& core = *core_;
  RHEXIS_CHECK(core.outcome == FrontOutcome::ok, "not factored");
  RHEXIS_CHECK(static_cast<std::size_t>(rows.rows()) == dof.size(), "{} dofs, {} rows", dof.size(), rows.rows());
  Forward out;
  const auto add_kept = [&](std::int32_t d, const auto& values) {
    const auto place = std::lower_bound(core.kept_dofs.begin(), core.kept_dofs.end(), d);
    RHEXIS_CHECK(place != core.kept_dofs.end() && *place == d, "dof {} is not in the assembly", d);
    out.kept.row(place - core.kept_dofs.begin()) += values;
  };
  out.kept = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(core.kept_dofs.size()), rows.cols());
  out.gram = Eigen::MatrixXd::Zero(rows.cols(), rows.cols());
  out.with_load = VectorX::Zero(rows.cols());

  std::map<std::int32_t, Eigen::MatrixXd> reached;  // by component
  const auto reach = [&](std::int32_t c) -> Eigen::MatrixXd& {
    Eigen::MatrixXd& r = reached[c];
    if (r.size() == 0) r = Eigen::MatrixXd::Zero(core.front(c)->size(), rows.cols());
    return r;
  };
  for (std::size_t i = 0; i < dof.size(); ++i) {
    const std::int32_t node = dof[i] / 3;
    RHEXIS_CHECK(dof[i] >= 0 && node < core.layout.node_count(), "dof {}", dof[i]);
    const auto row = rows.row(static_cast<Eigen::Index>(i));
    if (std::binary_search(core.kept.begin(), core.kept.end(), node)) {
      add_kept(dof[i], row);
      continue;
    }
    const std::int32_t c = core.find_front(node);
    const std::int32_t place = c >= 0 ? core.front(c)->find_pivot(core.layout.key(node), dof[i]) : -1;
    RHEXIS_CHECK(place >= 0, "dof {} is not in the assembly", dof[i]);
    reach(c).row(place) += row;
  }
  std::vector<std::int32_t> path;
  for (const auto& [c, r] : reached) path.push_back(c);
  path = core.paths_from(path);
  for (const std::int32_t c : path) {
    const Front& front = *core.front(c);
    Eigen::MatrixXd& r = reach(c);
    front_kernels().forward(front.panel.get(), front.ld(), front.pivots, front.boundary(), r.data(), front.size(),
                            static_cast<int>(r.cols()));
    out.front.push_back(c);
    out.y.emplace_back(r.topRows(front.pivots));
    out.gram.noalias() += out.y.back().transpose() * out.y.back();
    out.with_load.noalias() += out.y.back().transpose() * load_solution(front);
    const std::int32_t to = core.next(c);
    if (to < 0) {
      for (std::int32_t i = front.pivots; i < front.size(); ++i) add_kept(front.dofs[at(i)], r.row(i));
      continue;
    }
    Eigen::MatrixXd& s = reach(to);
    for (const Incoming& from : core.front(to)->incoming) {
      if (from.component != c) continue;
      for (const Run& run : from.runs) {
        s.middleRows(run.to, run.length) += r.middleRows(front.pivots + run.from, run.length);
      }
    }
  }
  return out;
}

void FrontTree::backward(const VectorX& x_kept, const Forward* forward, const VectorX& amount, double load_amount,
                         VectorX& x) const {
  const Core& core = *core_;
  core.check_solvable(x_kept);
  x.setZero(3 * Eigen::Index{core.layout.node_count()});
  x(core.kept_dofs) = x_kept;
  const Core::Backward backward(core, forward, amount, load_amount, x);
  for (std::size_t k = 0; k < core.direction.levels(); ++k) {  // those of one level write what is their own
    const std::span<const std::int32_t> together = core.direction.level(k);
    parallel_ranges(together.size(), kLevelGrain, [&](std::size_t begin, std::size_t end) {
      VectorX work;
      for (std::size_t i = begin; i < end; ++i) backward.solve(together[i], work);
    });
  }
}

void FrontTree::backward_at(std::span<const std::int32_t> nodes, const VectorX& x_kept, const Forward* forward,
                            const VectorX& amount, double load_amount, VectorX& x) const {
  const Core& core = *core_;
  core.check_solvable(x_kept);
  x.resize(3 * Eigen::Index{core.layout.node_count()});
  std::vector<std::int32_t> needed;
  for (const std::int32_t node : nodes) {
    RHEXIS_CHECK(node >= 0 && node < core.layout.node_count(), "node {} of {}", node, core.layout.node_count());
    x.segment<3>(3 * Eigen::Index{node}).setZero();
    const std::int32_t c = core.find_front(node);
    if (c >= 0) needed.push_back(c);
  }
  x(core.kept_dofs) = x_kept;
  const Core::Backward backward(core, forward, amount, load_amount, x);
  needed = core.paths_from(needed);
  VectorX work;
  for (auto c = needed.rbegin(); c != needed.rend(); ++c) backward.solve(*c, work);
}

}  // namespace rhexis::linalg
