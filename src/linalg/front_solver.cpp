#include "linalg/front_solver.h"

#include <algorithm>
#include <unordered_map>

#include "base/check.h"
#include "base/parallel.h"
#include "linalg/front_core.h"
#include "linalg/front_kernels.h"

namespace rhexis::linalg {
namespace {

/// Fronts of a level that one thread takes at a time.
constexpr std::size_t kLevelGrain = 16;
/// Entries of a front from which on several threads share it, and the rows or columns that one takes.
constexpr std::size_t kSharedFrom = std::size_t{1} << 18;
constexpr std::size_t kSharedGrain = 128;

std::size_t at(std::int32_t i) { return static_cast<std::size_t>(i); }

}  // namespace

/// W of a front, by columns.
struct FrontSolver::Panel {
  std::shared_ptr<const Front> front;
  std::vector<float> values;
  explicit Panel(std::shared_ptr<const Front> of) : front(std::move(of)) {
    values.resize(at(front->size()) * at(front->pivots));
    front_kernels().invert_panel(front->panel.get(), front->ld(), front->pivots, front->boundary(), values.data());
  }
};

FrontSolver::FrontSolver(const FrontTree& tree, const FrontSolver* before) {
  const FrontTree::Core& core = *tree.core_;
  RHEXIS_CHECK(core.outcome == FrontOutcome::ok, "not factored");
  RHEXIS_CHECK(core.kept.empty(), "{} nodes are kept", core.kept.size());
  size_ = 3 * Eigen::Index{core.layout.node_count()};
  std::vector<std::int32_t> step_of(core.fronts.size());
  std::vector<std::shared_ptr<const Front>> fronts;
  level_start_.push_back(0);
  std::int32_t used = 0;
  for (std::size_t k = 0; k < core.direction.levels(); ++k) {
    for (const std::int32_t component : core.direction.level(k)) {
      const Front& front = *core.front(component);
      step_of[at(component)] = static_cast<std::int32_t>(steps_.size());
      steps_.push_back({front.pivots, front.size(), used, 0, 0});
      used += front.size();
      dofs_.insert(dofs_.end(), front.dofs.begin(), front.dofs.end());
      fronts.push_back(core.fronts[at(component)]);
    }
    level_start_.push_back(static_cast<std::int32_t>(steps_.size()));
  }
  for (std::size_t s = 0; s < steps_.size(); ++s) {
    steps_[s].first_incoming = static_cast<std::int32_t>(incoming_.size());
    for (const linalg::Incoming& from : fronts[s]->incoming) {
      const Step& other = steps_[at(step_of[at(from.component)])];
      const auto first_run = static_cast<std::int32_t>(runs_.size());
      runs_.insert(runs_.end(), from.runs.begin(), from.runs.end());
      incoming_.push_back({other.work + other.pivots, first_run, static_cast<std::int32_t>(runs_.size())});
    }
    steps_[s].last_incoming = static_cast<std::int32_t>(incoming_.size());
  }
  std::unordered_map<const Front*, std::shared_ptr<const Panel>> known;
  if (before != nullptr) {
    for (const auto& panel : before->panels_) known.emplace(panel->front.get(), panel);
  }
  panels_.resize(fronts.size());
  parallel_for(fronts.size(), [&](std::size_t s) {
    const auto same = known.find(fronts[s].get());
    panels_[s] = same != known.end() ? same->second : std::make_shared<const Panel>(fronts[s]);
  });
}

template <typename Use>
void FrontSolver::for_each_of_level(std::size_t level, const Use& use) const {
  const std::size_t first = at(level_start_[level]);
  parallel_ranges(at(level_start_[level + 1]) - first, kLevelGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = first + begin; s < first + end; ++s) use(s);
  });
}

void FrontSolver::forward(std::size_t step, const VectorX& b, Work& work) const {
  const Step& front = steps_[step];
  float* const r = work.r.data() + front.work;
  float* const w = work.w.data() + front.work;
  const std::int32_t* const dof = dofs_.data() + front.work;
  for (std::int32_t i = 0; i < front.pivots; ++i) r[i] = static_cast<float>(b[dof[i]]);
  std::fill(r + front.pivots, r + front.size, 0.0F);
  for (std::int32_t k = front.first_incoming; k < front.last_incoming; ++k) {
    const Incoming& in = incoming_[at(k)];
    const float* const left = work.r.data() + in.from;
    for (std::int32_t n = in.first_run; n < in.last_run; ++n) {
      const Run& run = runs_[at(n)];
      for (std::int32_t i = 0; i < run.length; ++i) r[run.to + i] += left[run.from + i];
    }
  }
  const float* const W = panels_[step]->values.data();
  const auto product = [&](std::size_t begin, std::size_t end) {
    front_kernels().multiply_single(W + begin, front.size, static_cast<int>(end - begin), front.pivots, r, w + begin);
  };
  if (panels_[step]->values.size() < kSharedFrom) {
    product(0, at(front.size));
  } else {
    parallel_ranges(at(front.size), kSharedGrain, product);
  }
  std::copy(w, w + front.pivots, r);
  for (std::int32_t i = front.pivots; i < front.size; ++i) r[i] -= w[i];
}

void FrontSolver::backward(std::size_t step, VectorX& x, Work& work) const {
  const Step& front = steps_[step];
  float* const r = work.r.data() + front.work;
  float* const w = work.w.data() + front.work;
  const std::int32_t* const dof = dofs_.data() + front.work;
  for (std::int32_t i = front.pivots; i < front.size; ++i) r[i] = -static_cast<float>(x[dof[i]]);
  const float* const W = panels_[step]->values.data();
  const auto product = [&](std::size_t begin, std::size_t end) {
    front_kernels().multiply_transposed_single(W + begin * at(front.size), front.size, static_cast<int>(end - begin), r,
                                               w + begin);
  };
  if (panels_[step]->values.size() < kSharedFrom) {
    product(0, at(front.pivots));
  } else {
    parallel_ranges(at(front.pivots), kSharedGrain, product);
  }
  for (std::int32_t i = 0; i < front.pivots; ++i) x[dof[i]] = w[i];
}

void FrontSolver::solve(const VectorX& b, VectorX& x, Work& work) const {
  RHEXIS_CHECK(b.size() == size_, "{} entries for {} dofs", b.size(), size_);
  work.r.resize(static_cast<Eigen::Index>(dofs_.size()));
  work.w.resize(static_cast<Eigen::Index>(dofs_.size()));
  const std::size_t levels = level_start_.size() - 1;
  for (std::size_t k = levels; k-- > 0;) for_each_of_level(k, [&](std::size_t s) { forward(s, b, work); });
  x.setZero(size_);
  for (std::size_t k = 0; k < levels; ++k) for_each_of_level(k, [&](std::size_t s) { backward(s, x, work); });
}

std::size_t FrontSolver::memory_bytes() const {
  std::size_t bytes = sizeof(Step) * steps_.capacity() + sizeof(std::int32_t) * dofs_.capacity() +
                      sizeof(Run) * runs_.capacity() + sizeof(Incoming) * incoming_.capacity();
  for (const auto& panel : panels_) bytes += sizeof(float) * panel->values.capacity();
  return bytes;
}

}  // namespace rhexis::linalg
