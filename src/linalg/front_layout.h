#pragma once

/// Which component of the tree assembles an element and eliminates a node, and how this changes with the elements. No
/// numbers here.

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "linalg/front_array.h"
#include "linalg/front_dissection.h"

namespace rhexis::linalg {

/// Names a node and orders the nodes of all fronts in one way: by the component that it had at first, then by number.
/// So what a front hands on comes ordered as the next one has it, mostly in long runs.
using NodeKey = std::uint64_t;
[[nodiscard]] inline std::int32_t node_of(NodeKey key) { return static_cast<std::int32_t>(key & 0xffffffffU); }

/// Of one component.
struct Clique {
  std::vector<std::int32_t> elements;  ///< assembled here, ascending
  std::vector<NodeKey> boundary;       ///< nodes of elements of its subtree whose home is above it, ascending
};

struct LayoutChange {
  std::vector<std::int32_t> touched;  ///< components of elements that came, went or changed; ascending
  std::vector<std::int32_t> moved;    ///< components whose boundary is another; ascending
};

/// Always: the component of an element is, or lies below, the homes of its nodes; these lie on one path to the root.
class FrontLayout {
 public:
  /// `weight` as of FrontTree::make.
  FrontLayout(const ElementSource& elements, const std::vector<std::int32_t>& kept,
              std::span<const std::int32_t> weight);

  LayoutChange apply(const ElementSource& elements, const ElementChange& change);

  [[nodiscard]] const ComponentTree& tree() const { return *tree_; }
  [[nodiscard]] const Clique& clique(std::int32_t component) const {
    return *cliques_[static_cast<std::size_t>(component)];
  }
  [[nodiscard]] NodeKey key(std::int32_t node) const;
  /// -1: not in the assembly so far.
  [[nodiscard]] std::int32_t home(std::int32_t node) const { return places_[static_cast<std::size_t>(node)].home; }
  /// Components that may assemble an element none of whose nodes has its home there; ascending.
  [[nodiscard]] const std::vector<std::int32_t>& strays() const { return strays_; }
  [[nodiscard]] std::int32_t node_count() const { return static_cast<std::int32_t>(places_.size()); }
  [[nodiscard]] std::size_t memory_bytes() const;

 private:
  struct Place {
    std::int32_t home = -1;
    std::int32_t rank = 0;  // home at first: never changes
  };

  std::int32_t find_owner(const ElementSource& elements, std::int32_t element);
  void raise(std::int32_t node, std::int32_t owner);
  [[nodiscard]] std::vector<NodeKey> find_boundary(const ElementSource& elements, std::int32_t component,
                                                   const std::vector<std::int32_t>& own) const;

  std::shared_ptr<const ComponentTree> tree_;
  SharedArray<Place> places_;         // by node
  SharedArray<std::int32_t> owners_;  // by element, -1: not in the sum
  std::vector<std::shared_ptr<const Clique>> cliques_;
  std::vector<std::int32_t> strays_;
  std::vector<std::int32_t> raised_from_;  // components whose boundary gained a node that had its home there
};

}  // namespace rhexis::linalg
