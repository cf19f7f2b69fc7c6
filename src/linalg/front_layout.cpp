#include "linalg/front_layout.h"

#include <algorithm>
#include <limits>
#include <set>
#include <utility>

#include "base/check.h"

namespace rhexis::linalg {
namespace {

void sort_unique(auto& list) {
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

}  // namespace

FrontLayout::FrontLayout(const ElementSource& elements, const std::vector<std::int32_t>& kept,
                         std::span<const std::int32_t> weight) {
  Dissection cut = dissect(elements, kept, weight);
  tree_ = std::make_shared<const ComponentTree>(std::move(cut.tree));
  places_.resize(cut.home.size(), {});
  for (std::size_t i = 0; i < cut.home.size(); ++i) {
    const std::int32_t home = cut.home[i];
    places_.set(i, {home, home >= 0 ? home : std::numeric_limits<std::int32_t>::max()});
  }
  owners_.resize(static_cast<std::size_t>(elements.element_count()), -1);
  std::vector<std::vector<std::int32_t>> own(static_cast<std::size_t>(tree_->size()));
  for (std::int32_t e = 0; e < elements.element_count(); ++e) {
    if (!elements.is_active(e)) continue;
    const std::int32_t owner = find_owner(elements, e);
    owners_.set(static_cast<std::size_t>(e), owner);
    if (owner >= 0) own[static_cast<std::size_t>(owner)].push_back(e);
  }
  cliques_.resize(own.size());
  for (std::int32_t c = 0; c < tree_->size(); ++c) {
    auto& list = own[static_cast<std::size_t>(c)];
    std::vector<NodeKey> boundary = find_boundary(elements, c, list);
    cliques_[static_cast<std::size_t>(c)] =
        std::make_shared<const Clique>(Clique{std::move(list), std::move(boundary)});
  }
}

NodeKey FrontLayout::key(std::int32_t node) const {
  const auto rank = static_cast<NodeKey>(places_[static_cast<std::size_t>(node)].rank);
  return (rank << 32U) | static_cast<NodeKey>(static_cast<std::uint32_t>(node));
}

/// The deepest home among those of its nodes. A node that comes into the assembly now takes that home, too, and one
/// whose home lies on another branch (an edit has joined what the cut had parted) moves up to where the branches meet.
std::int32_t FrontLayout::find_owner(const ElementSource& elements, std::int32_t element) {
  const std::array<std::int32_t, 4> nodes = elements.nodes(element);
  std::int32_t owner = -1;
  bool any = false;
  for (const std::int32_t node : nodes) {
    if (!has_unknowns(elements, node)) continue;
    any = true;
    // In postorder whatever is below comes first; on different branches either will do.
    if (home(node) >= 0 && (owner < 0 || home(node) < owner)) owner = home(node);
  }
  if (!any) return -1;
  if (owner < 0) owner = tree_->root();
  for (const std::int32_t node : nodes) {
    if (has_unknowns(elements, node) && (home(node) < 0 || !tree_->holds(home(node), owner))) raise(node, owner);
  }
  return owner;
}

void FrontLayout::raise(std::int32_t node, std::int32_t owner) {
  Place place = places_[static_cast<std::size_t>(node)];
  if (place.home < 0) {
    place.home = owner;
  } else {
    const std::int32_t before = place.home;
    while (!tree_->holds(place.home, owner)) place.home = tree_->parent[static_cast<std::size_t>(place.home)];
    for (std::int32_t c = before; c != place.home; c = tree_->parent[static_cast<std::size_t>(c)]) {
      raised_from_.push_back(c);
    }
    // Elements that were assembled at the old home for this node's sake stay there.
    strays_.insert(std::upper_bound(strays_.begin(), strays_.end(), before), before);
    strays_.erase(std::unique(strays_.begin(), strays_.end()), strays_.end());
  }
  places_.set(static_cast<std::size_t>(node), place);
}

std::vector<NodeKey> FrontLayout::find_boundary(const ElementSource& elements, std::int32_t component,
                                                const std::vector<std::int32_t>& own) const {
  std::vector<NodeKey> out;
  for (const std::int32_t element : own) {
    for (const std::int32_t node : elements.nodes(element)) {
      if (has_unknowns(elements, node) && home(node) != component) out.push_back(key(node));
    }
  }
  sort_unique(out);
  for (const std::int32_t child : tree_->children[static_cast<std::size_t>(component)]) {
    const std::vector<NodeKey>& more = clique(child).boundary;
    const auto middle = static_cast<std::ptrdiff_t>(out.size());
    std::copy_if(more.begin(), more.end(), std::back_inserter(out),
                 [&](NodeKey k) { return home(node_of(k)) != component; });
    std::inplace_merge(out.begin(), out.begin() + middle, out.end());
  }
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

LayoutChange FrontLayout::apply(const ElementSource& elements, const ElementChange& change) {
  const auto nodes = static_cast<std::size_t>(elements.node_count());
  RHEXIS_CHECK(nodes >= change.copied.size(), "{} copies in {} nodes", change.copied.size(), nodes);
  places_.resize(std::min(nodes - change.copied.size(), places_.size()), {});
  RHEXIS_CHECK(places_.size() + change.copied.size() == nodes, "{} nodes and {} copies make {} nodes", places_.size(),
               change.copied.size(), nodes);
  for (const std::int32_t parent : change.copied) {
    RHEXIS_CHECK(parent >= 0 && parent < node_count(), "copy of node {} of {}", parent, node_count());
    const Place place = places_[static_cast<std::size_t>(parent)];
    places_.resize(places_.size() + 1, place);
  }
  raised_from_.clear();
  owners_.resize(std::max(owners_.size(), static_cast<std::size_t>(elements.element_count())), -1);

  std::vector<std::pair<std::int32_t, std::int32_t>> gone;  // component, element
  std::vector<std::pair<std::int32_t, std::int32_t>> come;
  std::set<std::int32_t> open;  // components whose lists are made again
  LayoutChange out;
  std::vector<std::int32_t> touched = change.touched;
  sort_unique(touched);
  for (const std::int32_t e : touched) {
    const std::int32_t before = owners_[static_cast<std::size_t>(e)];
    const bool active = e < elements.element_count() && elements.is_active(e);
    const std::int32_t after = active ? find_owner(elements, e) : -1;
    owners_.set(static_cast<std::size_t>(e), after);
    if (before >= 0) gone.emplace_back(before, e);
    if (after >= 0) come.emplace_back(after, e);
  }
  for (const auto& list : {gone, come}) {
    for (const auto& [component, element] : list) open.insert(component);
  }
  out.touched.assign(open.begin(), open.end());
  open.insert(raised_from_.begin(), raised_from_.end());
  sort_unique(gone);
  sort_unique(come);
  auto next_gone = gone.begin();
  auto next_come = come.begin();
  while (!open.empty()) {  // in postorder: a component comes after those below it
    const std::int32_t c = *open.begin();
    open.erase(open.begin());
    const Clique& before = clique(c);
    Clique now;
    for (const std::int32_t e : before.elements) {
      if (next_gone != gone.end() && *next_gone == std::pair(c, e)) {
        ++next_gone;
      } else {
        now.elements.push_back(e);
      }
    }
    const auto middle = static_cast<std::ptrdiff_t>(now.elements.size());
    for (; next_come != come.end() && next_come->first == c; ++next_come) now.elements.push_back(next_come->second);
    std::inplace_merge(now.elements.begin(), now.elements.begin() + middle, now.elements.end());
    now.boundary = find_boundary(elements, c, now.elements);
    if (now.boundary != before.boundary) {
      out.moved.push_back(c);
      if (tree_->parent[static_cast<std::size_t>(c)] >= 0) open.insert(tree_->parent[static_cast<std::size_t>(c)]);
    }
    cliques_[static_cast<std::size_t>(c)] = std::make_shared<const Clique>(std::move(now));
  }
  return out;
}

std::size_t FrontLayout::memory_bytes() const {
  std::size_t bytes = places_.memory_bytes() + owners_.memory_bytes();
  for (const auto& clique : cliques_) {
    bytes += sizeof(Clique) + sizeof(clique) + sizeof(std::int32_t) * clique->elements.capacity() +
             sizeof(NodeKey) * clique->boundary.capacity();
  }
  return bytes;
}

}  // namespace rhexis::linalg
