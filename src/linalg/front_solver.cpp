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
std::int32_t whole_packets(std::int32_t size) { return (size + kSinglePacket - 1) / kSinglePacket * kSinglePacket; }

}  // namespace

/// W of a front, by columns; zero below it.
struct FrontSolver::Panel {
  std::shared_ptr<const Front> front;
  std::vector<float> values;
  explicit Panel(std::shared_ptr<const Front> of) : front(std::move(of)) {
    const std::int32_t ld = whole_packets(front->size());
    values.assign(at(ld) * at(front->pivots), 0.0F);
    front_kernels().invert_panel(front->panel.get(), front->ld(), front->pivots, front->boundary(), values.data(), ld);
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
      const std::int32_t ld = whole_packets(front.size());
      steps_.push_back({front.pivots, front.size(), ld, static_cast<std::int32_t>(dofs_.size()), used, 0, 0});
      used += ld;
      dofs_.insert(dofs_.end(), front.dofs.begin(), front.dofs.end());
      fronts.push_back(core.fronts[at(component)]);
    }
    level_start_.push_back(static_cast<std::int32_t>(steps_.size()));
  }
  work_size_ = used;
  for (std::size_t s = 0; s < steps_.size(); ++s) {
    steps_[s].first_incoming = static_cast<std::int32_t>(incoming_.size());
    for (const linalg::Incoming& from : fronts[s]->incoming) {
      const auto first_run = static_cast<std::int32_t>(runs_.size());
      runs_.insert(runs_.end(), from.runs.begin(), from.runs.end());
      incoming_.push_back({step_of[at(from.component)], first_run, static_cast<std::int32_t>(runs_.size())});
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

template <int k>
void FrontSolver::forward(std::size_t step, const Lanes<k>& b, Work& work) const {
  const Step& front = steps_[step];
  const std::int32_t ld = front.ld;
  float* const r = work.r.data() + std::ptrdiff_t{k} * front.work;
  float* const w = work.w.data() + std::ptrdiff_t{k} * front.work;
  const std::int32_t* const dof = dofs_.data() + front.first;
  for (std::int32_t i = 0; i < front.pivots; ++i) {
    for (int lane = 0; lane < k; ++lane) r[lane * ld + i] = static_cast<float>(b(dof[i], lane));
  }
  for (int lane = 0; lane < k; ++lane) std::fill(r + lane * ld + front.pivots, r + (lane + 1) * ld, 0.0F);
  for (std::int32_t n = front.first_incoming; n < front.last_incoming; ++n) {
    const Incoming& in = incoming_[at(n)];
    const Step& other = steps_[at(in.step)];
    for (int lane = 0; lane < k; ++lane) {
      const float* const left = work.r.data() + std::ptrdiff_t{k} * other.work + lane * other.ld + other.pivots;
      float* const to = r + lane * ld;
      for (std::int32_t m = in.first_run; m < in.last_run; ++m) {
        const Run& run = runs_[at(m)];
        for (std::int32_t i = 0; i < run.length; ++i) to[run.to + i] += left[run.from + i];
      }
    }
  }
  const float* const W = panels_[step]->values.data();
  const auto product = [&](std::size_t begin, std::size_t end) {
    front_kernels().multiply_single(W + begin, ld, static_cast<int>(end - begin), front.pivots, k, r, ld, w + begin,
                                    ld);
  };
  if (panels_[step]->values.size() < kSharedFrom) {
    product(0, at(ld));
  } else {
    parallel_ranges(at(ld), kSharedGrain, product);
  }
  for (int lane = 0; lane < k; ++lane) {
    float* const to = r + lane * ld;
    const float* const from = w + lane * ld;
    std::copy(from, from + front.pivots, to);
    for (std::int32_t i = front.pivots; i < front.size; ++i) to[i] -= from[i];
  }
}

template <int k>
void FrontSolver::backward(std::size_t step, Lanes<k>& x, Work& work) const {
  const Step& front = steps_[step];
  const std::int32_t ld = front.ld;
  float* const r = work.r.data() + std::ptrdiff_t{k} * front.work;
  float* const w = work.w.data() + std::ptrdiff_t{k} * front.work;
  const std::int32_t* const dof = dofs_.data() + front.first;
  for (std::int32_t i = front.pivots; i < front.size; ++i) {
    for (int lane = 0; lane < k; ++lane) r[lane * ld + i] = -static_cast<float>(x(dof[i], lane));
  }
  const float* const W = panels_[step]->values.data();
  const auto product = [&](std::size_t begin, std::size_t end) {
    front_kernels().multiply_transposed_single(W + begin * at(ld), ld, ld, static_cast<int>(end - begin), k, r, ld,
                                               w + begin, ld);
  };
  if (panels_[step]->values.size() < kSharedFrom) {
    product(0, at(front.pivots));
  } else {
    parallel_ranges(at(front.pivots), kSharedGrain, product);
  }
  for (std::int32_t i = 0; i < front.pivots; ++i) {
    for (int lane = 0; lane < k; ++lane) x(dof[i], lane) = w[lane * ld + i];
  }
}

template <int k>
void FrontSolver::solve_lanes(const Lanes<k>& b, Lanes<k>& x, Work& work) const {
  RHEXIS_CHECK(b.rows() == size_, "{} entries for {} dofs", b.rows(), size_);
  work.r.resize(std::max(work.r.size(), k * work_size_));
  work.w.resize(work.r.size());
  const std::size_t levels = level_start_.size() - 1;
  for (std::size_t n = levels; n-- > 0;) for_each_of_level(n, [&](std::size_t s) { forward<k>(s, b, work); });
  x.setZero(size_, k);
  for (std::size_t n = 0; n < levels; ++n) for_each_of_level(n, [&](std::size_t s) { backward<k>(s, x, work); });
}

void FrontSolver::solve(const VectorX& b, VectorX& x, Work& work) const { solve_lanes<1>(b, x, work); }
void FrontSolver::solve(const TwoLanes& b, TwoLanes& x, Work& work) const { solve_lanes<2>(b, x, work); }
void FrontSolver::solve(const FourLanes& b, FourLanes& x, Work& work) const { solve_lanes<4>(b, x, work); }

std::size_t FrontSolver::memory_bytes() const {
  std::size_t bytes = sizeof(Step) * steps_.capacity() + sizeof(std::int32_t) * dofs_.capacity() +
                      sizeof(Run) * runs_.capacity() + sizeof(Incoming) * incoming_.capacity();
  for (const auto& panel : panels_) bytes += sizeof(float) * panel->values.capacity();
  return bytes;
}

}  // namespace rhexis::linalg
