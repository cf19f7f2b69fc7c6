#pragma once

/// The tree of a FrontTree: nested dissection of the nodes (George 1973; METIS through CHOLMOD) cuts the body in two by
/// a separator, each half again, until the pieces are small. A component is a separator, or a piece that is not cut any
/// more, and its children are the components of the pieces that it separates.

#include <cstdint>
#include <span>
#include <vector>

#include "linalg/front_tree.h"

namespace rhexis::linalg {

/// Components in postorder: children before parents, a subtree is a range. The last one is the root, which holds no
/// node at first: the pieces of a body that hangs together nowhere meet there.
struct ComponentTree {
  std::vector<std::int32_t> parent;  ///< -1: the root
  std::vector<std::int32_t> first;   ///< smallest component of the subtree, which is [first, component]
  std::vector<std::vector<std::int32_t>> children;

  [[nodiscard]] std::int32_t size() const { return static_cast<std::int32_t>(parent.size()); }
  [[nodiscard]] std::int32_t root() const { return size() - 1; }
  /// Whether `below` is `component` or one of its descendants.
  [[nodiscard]] bool holds(std::int32_t component, std::int32_t below) const {
    return first[static_cast<std::size_t>(component)] <= below && below <= component;
  }
};

struct Dissection {
  ComponentTree tree;
  std::vector<std::int32_t> home;  ///< per node, its component; -1: in no active element, or all its dofs are held
};

/// Whether any dof of the node is free.
[[nodiscard]] bool has_unknowns(const ElementSource& elements, std::int32_t node);

/// Nodes in `kept` are left out of the cutting; their home is the root. A separator is one of small weight: per node,
/// positive; empty: all 1.
[[nodiscard]] Dissection dissect(const ElementSource& elements, const std::vector<std::int32_t>& kept,
                                 std::span<const std::int32_t> weight);

}  // namespace rhexis::linalg
