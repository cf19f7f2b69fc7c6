#pragma once

/// One front of a multifrontal Cholesky factorisation (Duff and Reid 1983): a dense matrix over the dofs that a
/// component of the tree eliminates (its pivots) and those that they touch and others eliminate (its boundary).
///
///   [ F_pp  .    . ]   assembled from the component's elements and from what the fronts before it have left,
///   [ F_bp  F_bb . ]   then L_pp L_pp^T = F_pp, L_bp = F_bp L_pp^-T, U = F_bb - L_bp L_bp^T, handed on.
///   [ f_p^T f_b^T e]   The load is the last row: it comes out as y = L_pp^-1 f_p, f_b - L_bp y and e - y . y.

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "linalg/front_layout.h"
#include "linalg/front_lower.h"

namespace rhexis::linalg {

/// `length` boundary dofs of an earlier front from its `from` on are the dofs of this one from `to` on.
struct Run {
  std::int32_t from;
  std::int32_t to;
  std::int32_t length;
};

struct Incoming {
  std::int32_t component;  ///< whose front comes before this one
  std::vector<Run> runs;   ///< ascending; each within the pivots or within the boundary
};

/// Never changes once made.
struct Front {
  std::vector<NodeKey> nodes;      ///< of the pivots, then of the boundary, each ascending
  std::size_t pivot_nodes = 0;     ///< those of the pivots
  std::vector<std::int32_t> dofs;  ///< free dofs of the nodes, in their order
  std::int32_t pivots = 0;         ///< dofs of the pivots
  std::vector<Incoming> incoming;
  std::vector<std::int32_t> set_aside;  ///< the component's elements that lie wholly in kept nodes
  Block panel;                          ///< L_pp, L_bp, y^T: ld() x pivots; nothing of meaning above the diagonal
  LowerTriangle update;                 ///< U, (f_b - L_bp y)^T, e - y . y
  std::vector<double> assembled;        ///< per boundary dof, what elements have put on its diagonal so far
  double flops = 0.0;
  bool positive_definite = true;

  [[nodiscard]] std::int32_t size() const { return static_cast<std::int32_t>(dofs.size()); }
  [[nodiscard]] std::int32_t boundary() const { return size() - pivots; }
  [[nodiscard]] std::int32_t ld() const { return size() + 1; }
  [[nodiscard]] std::size_t panel_entries() const {
    return static_cast<std::size_t>(ld()) * static_cast<std::size_t>(pivots);
  }
  [[nodiscard]] std::span<const NodeKey> pivot_keys() const { return {nodes.data(), pivot_nodes}; }
  [[nodiscard]] std::span<const NodeKey> boundary_keys() const { return std::span(nodes).subspan(pivot_nodes); }
  /// Place of a free dof of a node among the pivots; -1: not a pivot here.
  [[nodiscard]] std::int32_t find_pivot(NodeKey node, std::int32_t dof) const;
  [[nodiscard]] std::size_t memory_bytes() const;
};

/// What a front is made of.
struct FrontInput {
  const ElementSource& source;
  const FrontLayout& layout;
  std::int32_t component;
  std::span<const NodeKey> beyond;                            ///< nodes that fronts after it still touch, ascending
  std::span<const NodeKey> kept;                              ///< ascending
  std::vector<std::pair<std::int32_t, const Front*>> before;  ///< the fronts that hand on to it
  double null_pivot;  ///< a pivot below this fraction of its assembled diagonal entry is rounding
};

/// Whether all nodes of the element that have unknowns are kept.
[[nodiscard]] bool lies_in_kept(const ElementSource& source, const FrontLayout& layout, std::span<const NodeKey> kept,
                                std::int32_t element);

/// A large one is spread over threads; the bits do not depend on who works where.
[[nodiscard]] std::shared_ptr<const Front> make_front(const FrontInput& input);

}  // namespace rhexis::linalg
