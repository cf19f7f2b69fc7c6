#include "linalg/front_core.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/parallel.h"

namespace rhexis::linalg {
namespace {

std::size_t at(std::int32_t i) { return static_cast<std::size_t>(i); }

// Operations of a level below which it is done before a thread has come, and what a front that was not there counts.
constexpr double kForkFrom = 5e6;
constexpr double kSomeFlops = 1e6;

}  // namespace

Direction direct(const ComponentTree& tree, std::int32_t last) {
  Direction out;
  out.last = last;
  out.next = tree.parent;
  for (std::int32_t c = last; c != tree.root(); c = tree.parent[at(c)]) out.next[at(tree.parent[at(c)])] = c;
  out.next[at(last)] = -1;
  out.order.reserve(tree.parent.size());
  for (std::int32_t c = 0; c < tree.size(); ++c) {
    if (!tree.holds(c, last)) out.order.push_back(c);
  }
  for (std::int32_t c = tree.root(); c >= 0; c = out.next[at(c)]) out.order.push_back(c);

  std::vector<std::int32_t> depth(out.order.size(), 0);
  std::int32_t deepest = 0;
  for (auto c = out.order.rbegin(); c != out.order.rend(); ++c) {
    if (out.next[at(*c)] >= 0) depth[at(*c)] = depth[at(out.next[at(*c)])] + 1;
    deepest = std::max(deepest, depth[at(*c)]);
  }
  out.level_start.assign(at(deepest) + 2, 0);
  for (const std::int32_t d : depth) ++out.level_start[at(d) + 1];
  for (std::size_t k = 1; k < out.level_start.size(); ++k) out.level_start[k] += out.level_start[k - 1];
  out.by_level.resize(out.order.size());
  std::vector<std::int32_t> place(out.level_start.begin(), out.level_start.end() - 1);
  for (auto c = out.order.rbegin(); c != out.order.rend(); ++c) out.by_level[at(place[at(depth[at(*c)])]++)] = *c;
  return out;
}

std::span<const NodeKey> FrontTree::Core::beyond(std::int32_t component) const {
  const std::int32_t to = next(component);
  if (to < 0) return {};
  const bool upwards = layout.tree().parent[at(component)] == to;
  return layout.clique(upwards ? component : to).boundary;
}

std::int32_t FrontTree::Core::find_front(std::int32_t node) const {
  const NodeKey key = layout.key(node);
  for (std::int32_t c = layout.home(node); c >= 0; c = next(c)) {
    if (front(c) == nullptr) continue;
    const std::span<const NodeKey> pivots = front(c)->pivot_keys();
    if (std::binary_search(pivots.begin(), pivots.end(), key)) return c;
  }
  return -1;
}

std::vector<std::int32_t> FrontTree::Core::paths_from(const std::vector<std::int32_t>& components) const {
  std::vector<char> found(fronts.size(), 0);
  std::vector<std::int32_t> out;
  for (std::int32_t c : components) {
    for (; c >= 0 && found[at(c)] == 0; c = next(c)) {
      found[at(c)] = 1;
      out.push_back(c);
    }
  }
  // Those that do not hold the last one hand on upwards, and come first; those that do hand on downwards.
  const ComponentTree& tree = layout.tree();
  const auto rank = [&](std::int32_t c) { return tree.holds(c, direction.last) ? 2 * tree.size() - c : c; };
  std::sort(out.begin(), out.end(), [&](std::int32_t a, std::int32_t b) { return rank(a) < rank(b); });
  return out;
}

void FrontTree::Core::check_solvable(const VectorX& x_kept) const {
  RHEXIS_CHECK(outcome == FrontOutcome::ok, "not factored");
  RHEXIS_CHECK(static_cast<std::size_t>(x_kept.size()) == kept_dofs.size(), "{} values for {} kept dofs", x_kept.size(),
               kept_dofs.size());
}

void FrontTree::Core::set_kept(const std::vector<std::int32_t>& nodes) {
  kept = nodes;
  kept_keys.clear();
  for (const std::int32_t node : nodes) kept_keys.push_back(layout.key(node));
  std::sort(kept_keys.begin(), kept_keys.end());
}

void FrontTree::Core::factor(const ElementSource& source, std::vector<char> marked) {
  const ComponentTree& tree = layout.tree();
  // A front waits for those before it: levels of fronts that wait for none of the same level.
  std::vector<std::int32_t> level(marked.size(), 0);
  std::vector<std::vector<std::int32_t>> levels;
  std::vector<double> expected_flops;  // of each level, as they were last time
  made = 0;
  for (const std::int32_t c : direction.order) {
    if (marked[at(c)] == 0) continue;
    if (at(level[at(c)]) == levels.size()) {
      levels.emplace_back();
      expected_flops.push_back(0.0);
    }
    levels[at(level[at(c)])].push_back(c);
    expected_flops[at(level[at(c)])] += front(c) != nullptr ? front(c)->flops : kSomeFlops;
    fronts[at(c)].reset();
    ++made;
    const std::int32_t to = next(c);
    if (to < 0) continue;
    marked[at(to)] = 1;
    level[at(to)] = std::max(level[at(to)], level[at(c)] + 1);
  }
  const auto make_one = [&](std::int32_t c) {
    FrontInput input{source, layout, c, beyond(c), kept_keys, {}, null_pivot};
    const auto take = [&](std::int32_t neighbour) {
      if (neighbour < 0 || next(neighbour) != c) return true;
      input.before.emplace_back(neighbour, front(neighbour));
      return front(neighbour) != nullptr && front(neighbour)->positive_definite;
    };
    bool ready = take(tree.parent[at(c)]);
    for (const std::int32_t child : tree.children[at(c)]) ready = take(child) && ready;
    if (ready) fronts[at(c)] = make_front(input);
  };
  for (std::size_t l = 0; l < levels.size(); ++l) {
    const std::vector<std::int32_t>& together = levels[l];
    if (expected_flops[l] < kForkFrom) {
      for (const std::int32_t c : together) make_one(c);
    } else {
      parallel_for(together.size(), [&](std::size_t i) { make_one(together[i]); });
    }
  }
  flops = 0.0;
  outcome = FrontOutcome::ok;
  for (const std::vector<std::int32_t>& together : levels) {
    for (const std::int32_t c : together) flops += front(c) != nullptr ? front(c)->flops : 0.0;
  }
  for (const auto& front : fronts) {
    if (front == nullptr || !front->positive_definite) outcome = FrontOutcome::not_positive_definite;
  }
  if (outcome == FrontOutcome::ok) condense(source);
}

void FrontTree::Core::lay_in_blocks() const {
  constexpr std::size_t kDearest = 16;  // fronts: those about the largest separators, which a crack crosses in turn
  std::vector<const Front*> largest;
  for (const auto& front : fronts) {
    if (front != nullptr) largest.push_back(front.get());
  }
  const std::size_t count = std::min(kDearest, largest.size());
  std::partial_sort(largest.begin(), largest.begin() + static_cast<std::ptrdiff_t>(count), largest.end(),
                    [](const Front* a, const Front* b) { return a->memory_bytes() > b->memory_bytes(); });
  std::vector<Block> blocks;
  for (std::size_t i = 0; i < count; ++i) {
    for (const std::size_t entries : {largest[i]->panel_entries(), largest[i]->update.entries()})
      blocks.push_back(make_zeroed(entries));
  }
}

/// What the last front leaves on the kept dofs, and the elements and loads that are theirs alone.
void FrontTree::Core::condense(const ElementSource& source) {
  const Front& last = *front(direction.last);
  std::vector<std::int32_t> elements;
  for (const auto& front : fronts) elements.insert(elements.end(), front->set_aside.begin(), front->set_aside.end());
  std::sort(elements.begin(), elements.end());
  kept_dofs.assign(last.dofs.begin() + last.pivots, last.dofs.end());
  for (const std::int32_t element : elements) {
    for (const std::int32_t node : source.nodes(element)) {
      for (std::int32_t dof = 3 * node; dof < 3 * node + 3; ++dof) {
        if (source.is_free(dof)) kept_dofs.push_back(dof);
      }
    }
  }
  std::sort(kept_dofs.begin(), kept_dofs.end());
  kept_dofs.erase(std::unique(kept_dofs.begin(), kept_dofs.end()), kept_dofs.end());
  const auto place = [&](std::int32_t dof) {
    return static_cast<Eigen::Index>(std::lower_bound(kept_dofs.begin(), kept_dofs.end(), dof) - kept_dofs.begin());
  };
  const auto n = static_cast<Eigen::Index>(kept_dofs.size());
  schur = Eigen::MatrixXd::Zero(n, n);
  schur_load = VectorX::Zero(n);
  std::vector<Eigen::Index> to;
  for (std::int32_t i = last.pivots; i < last.size(); ++i) to.push_back(place(last.dofs[at(i)]));
  const std::int32_t load = last.boundary();
  for (std::int32_t j = 0; j < load; ++j) {
    const double* const column = last.update.column(j);
    for (std::int32_t i = j; i < load; ++i) schur(to[at(i)], to[at(j)]) = schur(to[at(j)], to[at(i)]) = column[i];
    schur_load[to[at(j)]] = column[load];
  }
  load_energy = -last.update.column(load)[load];
  ElementMatrix K;
  ElementVector f;
  for (const std::int32_t element : elements) {
    source.stiffness(element, K);
    source.load(element, f);
    const std::array<std::int32_t, 4> nodes = source.nodes(element);
    std::array<Eigen::Index, 12> row{};
    for (std::size_t i = 0; i < 12; ++i) {
      const std::int32_t dof = 3 * nodes[i / 3] + static_cast<std::int32_t>(i % 3);
      row[i] = source.is_free(dof) ? place(dof) : -1;
    }
    for (std::size_t j = 0; j < 12; ++j) {
      if (row[j] < 0) continue;
      const auto col = static_cast<Eigen::Index>(j);
      for (std::size_t i = 0; i < 12; ++i) {
        if (row[i] >= 0) schur(row[i], row[j]) += K(static_cast<Eigen::Index>(i), col);
      }
      schur_load[row[j]] += f[col];
    }
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    const std::int32_t dof = kept_dofs[static_cast<std::size_t>(i)];
    schur_load[i] += source.node_load(dof / 3)[dof % 3];
  }
  if (!schur.diagonal().allFinite() || !schur_load.allFinite() || !std::isfinite(load_energy)) {
    outcome = FrontOutcome::not_positive_definite;
  }
}

}  // namespace rhexis::linalg
