#include "linalg/front_tree.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "base/check.h"
#include "linalg/front_core.h"
#include "linalg/null_pivot.h"

namespace rhexis::linalg {
namespace {

std::size_t at(std::int32_t i) { return static_cast<std::size_t>(i); }

// So many kept nodes are carried to wherever the last front is for next to nothing: the hand that comes and goes does
// not draw it away from the crack.
constexpr std::size_t kFewNodes = 16;

/// The component in the middle of the nodes, or else of the components: most lies neither below any one child of it,
/// nor above. Nodes that are always kept have no place. `otherwise` when there is nothing.
std::int32_t middle_of(const FrontLayout& layout, std::span<const std::int32_t> nodes,
                       const std::vector<std::int32_t>& components, std::int32_t otherwise) {
  const ComponentTree& tree = layout.tree();
  std::vector<std::int32_t> count(at(tree.size()), 0);
  for (const std::int32_t node : nodes) {
    if (layout.home(node) >= 0) ++count[at(layout.home(node))];
  }
  if (nodes.empty()) {
    for (const std::int32_t component : components) ++count[at(component)];
  }
  count[at(tree.root())] = 0;
  for (std::int32_t c = 0; c < tree.root(); ++c) count[at(tree.parent[at(c)])] += count[at(c)];
  const std::int32_t all = count[at(tree.root())];
  if (all == 0) return otherwise;
  std::int32_t c = tree.root();
  for (bool deeper = true; deeper;) {
    deeper = false;
    for (const std::int32_t child : tree.children[at(c)]) {
      if (2 * count[at(child)] > all) {
        c = child;
        deeper = true;
        break;
      }
    }
  }
  return c;
}

bool meet(std::span<const NodeKey> a, std::span<const NodeKey> b) {
  for (auto i = a.begin(), j = b.begin(); i != a.end() && j != b.end();) {
    if (*i == *j) return true;
    *i < *j ? ++i : ++j;
  }
  return false;
}

/// Components that assemble elements that may lie wholly in kept nodes.
std::vector<std::int32_t> components_at(const FrontLayout& layout, const std::vector<std::int32_t>& kept) {
  std::vector<std::int32_t> out = layout.strays();
  for (const std::int32_t node : kept) {
    if (layout.home(node) >= 0) out.push_back(layout.home(node));
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

}  // namespace

FrontTree::FrontTree(std::unique_ptr<const Core> core) : core_(std::move(core)) {}
FrontTree::~FrontTree() = default;

std::shared_ptr<const FrontTree> FrontTree::make(const ElementSource& elements, const std::vector<std::int32_t>& kept,
                                                 std::span<const std::int32_t> weight,
                                                 std::span<const std::int32_t> next) {
  auto core = std::make_unique<Core>(FrontLayout(elements, kept, weight));
  core->null_pivot = null_pivot(3 * elements.node_count());
  core->set_kept(kept);
  core->direction = direct(core->layout.tree(), middle_of(core->layout, next, {}, core->layout.tree().root()));
  core->fronts.resize(at(core->layout.tree().size()));
  core->factor(elements, std::vector<char>(core->fronts.size(), 1));
  core->lay_in_blocks();
  return std::shared_ptr<const FrontTree>(new FrontTree(std::move(core)));
}

std::shared_ptr<const FrontTree> FrontTree::updated(const ElementSource& elements, const ElementChange& change) const {
  const Core& old = *core_;
  auto core = std::make_unique<Core>(old.layout);
  core->null_pivot = old.null_pivot;
  core->fronts = old.fronts;
  const LayoutChange moves = core->layout.apply(elements, change);
  core->set_kept(change.kept);
  const ComponentTree& tree = core->layout.tree();
  std::int32_t last = old.direction.last;
  if (!moves.touched.empty()) {
    // As near to the next change as it can come among the fronts that this one makes anew in any case.
    const std::vector<std::int32_t> made = old.paths_from(moves.touched);
    last = middle_of(core->layout, change.next, moves.touched, last);
    while (std::find(made.begin(), made.end(), last) == made.end()) last = old.next(last);
  } else if (core->kept.size() > kFewNodes) {
    last = middle_of(core->layout, core->kept, {}, last);
  }
  core->direction = last == old.direction.last ? old.direction : direct(tree, last);

  std::vector<char> marked(core->fronts.size(), 0);
  const auto mark = [&](std::int32_t component) {
    if (component >= 0) marked[at(component)] = 1;
  };
  for (const std::int32_t c : moves.touched) mark(c);
  for (std::int32_t c = 0; c < tree.size(); ++c) {
    if (core->next(c) != old.next(c) || core->front(c) == nullptr || !core->front(c)->positive_definite) mark(c);
  }
  // A front whose pivots others now touch as well must leave them. One that leaves more than it must is as good.
  for (const std::int32_t c : moves.moved) {
    const std::int32_t above = tree.parent[at(c)];
    const std::int32_t from = core->next(c) == above ? c : above;
    if (from < 0 || core->front(from) == nullptr) continue;
    if (meet(core->front(from)->pivot_keys(), core->layout.clique(c).boundary)) mark(from);
  }
  std::vector<std::int32_t> changed;
  std::set_difference(core->kept.begin(), core->kept.end(), old.kept.begin(), old.kept.end(),
                      std::back_inserter(changed));
  for (const std::int32_t node : changed) {
    if (node < old.layout.node_count()) mark(old.find_front(node));
  }
  changed.clear();
  std::set_difference(old.kept.begin(), old.kept.end(), core->kept.begin(), core->kept.end(),
                      std::back_inserter(changed));
  for (const std::int32_t node : changed) {
    if (node >= core->layout.node_count()) continue;
    std::int32_t c = core->layout.home(node);
    const NodeKey key = core->layout.key(node);
    for (bool on = c >= 0; on;) {
      const std::span<const NodeKey> beyond = core->beyond(c);
      on = std::binary_search(beyond.begin(), beyond.end(), key);
      if (on) c = core->next(c);
    }
    mark(c);
  }
  std::vector<std::int32_t> may_set_aside = components_at(core->layout, core->kept);
  for (std::int32_t c = 0; c < tree.size(); ++c) {
    if (marked[at(c)] == 0 && !core->front(c)->set_aside.empty()) may_set_aside.push_back(c);
  }
  for (const std::int32_t c : may_set_aside) {
    if (marked[at(c)] != 0) continue;
    std::vector<std::int32_t> aside;
    for (const std::int32_t e : core->layout.clique(c).elements) {
      if (lies_in_kept(elements, core->layout, core->kept_keys, e)) aside.push_back(e);
    }
    if (aside != core->front(c)->set_aside) mark(c);
  }
  core->factor(elements, std::move(marked));
  return std::shared_ptr<const FrontTree>(new FrontTree(std::move(core)));
}

std::shared_ptr<const FrontTree> FrontTree::refactored(const ElementSource& elements) const {
  auto core = std::make_unique<Core>(core_->layout);
  core->null_pivot = core_->null_pivot;
  core->set_kept(core_->kept);
  core->direction = core_->direction;
  core->fronts.resize(core_->fronts.size());
  core->factor(elements, std::vector<char>(core->fronts.size(), 1));
  return std::shared_ptr<const FrontTree>(new FrontTree(std::move(core)));
}

FrontOutcome FrontTree::outcome() const { return core_->outcome; }
const std::vector<std::int32_t>& FrontTree::kept_dofs() const { return core_->kept_dofs; }
const Eigen::MatrixXd& FrontTree::schur() const { return core_->schur; }
const VectorX& FrontTree::schur_load() const { return core_->schur_load; }
double FrontTree::load_energy() const { return core_->load_energy; }
std::size_t FrontTree::front_count() const { return core_->fronts.size(); }
std::size_t FrontTree::fronts_made() const { return core_->made; }
double FrontTree::flops_made() const { return core_->flops; }

std::size_t FrontTree::memory_bytes() const {
  std::size_t bytes = core_->layout.memory_bytes() + sizeof(double) * static_cast<std::size_t>(core_->schur.size());
  for (const auto& front : core_->fronts) bytes += front != nullptr ? front->memory_bytes() : 0;
  return bytes;
}

}  // namespace rhexis::linalg
