#include "linalg/front.h"

#include <algorithm>
#include <iterator>

#include "base/parallel.h"
#include "linalg/front_factor.h"
#include "linalg/front_kernels.h"

namespace rhexis::linalg {
namespace {

bool contains(std::span<const NodeKey> sorted, NodeKey key) {
  return std::binary_search(sorted.begin(), sorted.end(), key);
}

/// A front while it is made.
class FrontMaker {
 public:
  explicit FrontMaker(const FrontInput& input) : in_(input), front_(std::make_shared<Front>()), f_(*front_) {}

  std::shared_ptr<const Front> make() {
    find_nodes();
    find_dofs();
    f_.panel = make_zeroed(f_.panel_entries());
    f_.update = LowerTriangle(f_.boundary() + 1);
    diagonal_.assign(f_.dofs.size(), 0.0);
    add_elements();
    add_node_loads();
    for (const auto& [component, before] : in_.before) add_update(component, *before);
    eliminate_pivots(f_, diagonal_, in_.null_pivot);
    f_.assembled.assign(diagonal_.begin() + f_.pivots, diagonal_.end());
    return front_;
  }

 private:
  void find_nodes();
  void find_dofs();
  void add_elements();
  void add_node_loads();
  void add_update(std::int32_t component, const Front& before);
  [[nodiscard]] std::vector<Run> find_runs(const Front& before) const;
  void add_columns(const Front& before, std::span<const Run> runs, std::int32_t begin, std::int32_t end);
  [[nodiscard]] std::int32_t first_dof(NodeKey key) const;
  [[nodiscard]] double& panel(std::int32_t row, std::int32_t column) {
    return f_
        .panel[static_cast<std::size_t>(column) * static_cast<std::size_t>(f_.ld()) + static_cast<std::size_t>(row)];
  }

  const FrontInput& in_;
  std::shared_ptr<Front> front_;
  Front& f_;
  std::vector<std::int32_t> elements_;   // those assembled here
  std::vector<std::int32_t> first_dof_;  // per node, where its dofs begin
  std::vector<double> diagonal_;         // per dof, what elements have put there
};

void FrontMaker::find_nodes() {
  std::vector<NodeKey> all;
  for (const std::int32_t element : in_.layout.clique(in_.component).elements) {
    const std::size_t count = all.size();
    bool kept = true;
    for (const std::int32_t node : in_.source.nodes(element)) {
      if (!has_unknowns(in_.source, node)) continue;
      all.push_back(in_.layout.key(node));
      kept = kept && contains(in_.kept, all.back());
    }
    if (kept) {
      all.resize(count);
      f_.set_aside.push_back(element);
    } else {
      elements_.push_back(element);
    }
  }
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  for (const auto& [component, before] : in_.before) {
    const std::span<const NodeKey> more = before->boundary_keys();
    const auto middle = static_cast<std::ptrdiff_t>(all.size());
    all.insert(all.end(), more.begin(), more.end());
    std::inplace_merge(all.begin(), all.begin() + middle, all.end());
  }
  all.erase(std::unique(all.begin(), all.end()), all.end());
  const auto stays = [&](NodeKey key) { return contains(in_.beyond, key) || contains(in_.kept, key); };
  std::vector<NodeKey> boundary;
  f_.nodes.reserve(all.size());
  for (const NodeKey key : all) (stays(key) ? boundary : f_.nodes).push_back(key);
  f_.pivot_nodes = f_.nodes.size();
  f_.nodes.insert(f_.nodes.end(), boundary.begin(), boundary.end());
}

void FrontMaker::find_dofs() {
  f_.dofs.reserve(3 * f_.nodes.size());
  first_dof_.reserve(f_.nodes.size());
  for (std::size_t i = 0; i < f_.nodes.size(); ++i) {
    if (i == f_.pivot_nodes) f_.pivots = f_.size();
    first_dof_.push_back(f_.size());
    const std::int32_t node = node_of(f_.nodes[i]);
    const unsigned free = in_.source.free_components(node);
    for (std::int32_t c = 0; c < 3; ++c) {
      if ((free >> c & 1U) != 0) f_.dofs.push_back(3 * node + c);
    }
  }
  if (f_.pivot_nodes == f_.nodes.size()) f_.pivots = f_.size();
}

std::int32_t FrontMaker::first_dof(NodeKey key) const {
  const auto middle = f_.nodes.begin() + static_cast<std::ptrdiff_t>(f_.pivot_nodes);
  auto at = std::lower_bound(f_.nodes.begin(), middle, key);
  if (at == middle || *at != key) at = std::lower_bound(middle, f_.nodes.end(), key);
  return first_dof_[static_cast<std::size_t>(at - f_.nodes.begin())];
}

void FrontMaker::add_elements() {
  ElementMatrix K;
  ElementVector load;
  std::array<std::int32_t, 12> at{};
  const std::int32_t p = f_.pivots;
  for (const std::int32_t element : elements_) {
    in_.source.stiffness(element, K);
    in_.source.load(element, load);
    const std::array<std::int32_t, 4> nodes = in_.source.nodes(element);
    for (std::size_t a = 0; a < 4; ++a) {
      const unsigned free = in_.source.free_components(nodes[a]);
      std::int32_t next = free != 0 ? first_dof(in_.layout.key(nodes[a])) : -1;
      for (std::size_t c = 0; c < 3; ++c) at[3 * a + c] = (free >> c & 1U) != 0 ? next++ : -1;
    }
    for (std::size_t j = 0; j < 12; ++j) {
      const std::int32_t column = at[j];
      if (column < 0) continue;
      const auto col = static_cast<Eigen::Index>(j);
      double* const to = column < p ? &panel(0, column) : f_.update.column(column - p) - p;
      for (std::size_t i = 0; i < 12; ++i) {
        if (at[i] >= column) to[at[i]] += K(static_cast<Eigen::Index>(i), col);
      }
      to[f_.size()] += load[col];
      diagonal_[static_cast<std::size_t>(column)] += K(col, col);
    }
  }
}

/// A node's own load is added where the node is eliminated.
void FrontMaker::add_node_loads() {
  for (std::int32_t j = 0; j < f_.pivots; ++j) {
    const std::int32_t dof = f_.dofs[static_cast<std::size_t>(j)];
    panel(f_.size(), j) += in_.source.node_load(dof / 3)[dof % 3];
  }
}

std::vector<Run> FrontMaker::find_runs(const Front& before) const {
  std::vector<Run> runs;
  const std::span<const NodeKey> theirs = before.boundary_keys();
  std::size_t pivot = 0;
  std::size_t boundary = f_.pivot_nodes;
  std::int32_t from = 0;
  for (const NodeKey key : theirs) {
    while (pivot < f_.pivot_nodes && f_.nodes[pivot] < key) ++pivot;
    while (boundary < f_.nodes.size() && f_.nodes[boundary] < key) ++boundary;
    const std::size_t at = pivot < f_.pivot_nodes && f_.nodes[pivot] == key ? pivot : boundary;
    const std::int32_t to = first_dof_[at];
    const std::int32_t end = at + 1 < first_dof_.size() ? first_dof_[at + 1] : f_.size();
    if (!runs.empty() && runs.back().to + runs.back().length == to && to != f_.pivots) {
      runs.back().length += end - to;
    } else {
      runs.push_back({from, to, end - to});
    }
    from += end - to;
  }
  return runs;
}

/// Extend-add. Each entry of what is handed on has a place of its own here, so that columns are added at once.
void FrontMaker::add_update(std::int32_t component, const Front& before) {
  std::vector<Run> runs = find_runs(before);
  const std::int32_t load = before.boundary();
  constexpr std::int32_t kForkFrom = 512;  // columns; below, it is done before a thread has come
  if (load >= kForkFrom) {
    parallel_ranges(static_cast<std::size_t>(load), before.update.width(), [&](std::size_t begin, std::size_t end) {
      add_columns(before, runs, static_cast<std::int32_t>(begin), static_cast<std::int32_t>(end));
    });
  } else {
    add_columns(before, runs, 0, load);
  }
  f_.update.column(f_.boundary())[f_.boundary()] += before.update.column(load)[load];
  f_.incoming.push_back({component, std::move(runs)});
}

/// Columns [begin, end) of an update. It is ordered as here, but for the nodes that became pivots or have ceased to be
/// kept in between, so that an entry below the diagonal may come to lie above it only where a pivot and a boundary row
/// meet.
void FrontMaker::add_columns(const Front& before, std::span<const Run> runs, std::int32_t begin, std::int32_t end) {
  const FrontKernels& kernels = front_kernels();
  const std::int32_t p = f_.pivots;
  std::size_t r = 0;
  for (std::int32_t from = begin; from < end; ++from) {
    while (runs[r].from + runs[r].length <= from) ++r;
    const double* const column = before.update.column(from);
    const std::int32_t j = runs[r].to + from - runs[r].from;
    double* const to = j < p ? &panel(0, j) : f_.update.column(j - p) - p;
    for (std::size_t s = r; s < runs.size(); ++s) {
      const std::int32_t skip = s == r ? from - runs[r].from : 0;
      const double* const a = column + runs[s].from + skip;
      const std::int32_t i = runs[s].to + skip;
      const std::int32_t count = runs[s].length - skip;
      if (i < p && j >= p) {
        for (std::int32_t k = 0; k < count; ++k) panel(j, i + k) += a[k];
      } else {
        kernels.add(to + i, a, count);
      }
    }
    to[f_.size()] += column[before.boundary()];
    diagonal_[static_cast<std::size_t>(j)] += before.assembled[static_cast<std::size_t>(from)];
  }
}

}  // namespace

std::int32_t Front::find_pivot(NodeKey node, std::int32_t dof) const {
  if (!contains(pivot_keys(), node)) return -1;
  const auto end = dofs.begin() + pivots;
  return static_cast<std::int32_t>(std::find(dofs.begin(), end, dof) - dofs.begin());
}

std::size_t Front::memory_bytes() const {
  std::size_t runs = 0;
  for (const Incoming& from : incoming) runs += from.runs.capacity();
  return sizeof(Front) + sizeof(NodeKey) * nodes.capacity() +
         sizeof(std::int32_t) * (dofs.capacity() + set_aside.capacity()) + sizeof(Run) * runs +
         sizeof(double) * (panel_entries() + update.entries() + assembled.capacity());
}

bool lies_in_kept(const ElementSource& source, const FrontLayout& layout, std::span<const NodeKey> kept,
                  std::int32_t element) {
  const std::array<std::int32_t, 4> nodes = source.nodes(element);
  return std::all_of(nodes.begin(), nodes.end(), [&](std::int32_t node) {
    return !has_unknowns(source, node) || contains(kept, layout.key(node));
  });
}

std::shared_ptr<const Front> make_front(const FrontInput& input) { return FrontMaker(input).make(); }

}  // namespace rhexis::linalg
