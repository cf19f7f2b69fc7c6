#pragma once

/// Inside of FrontTree: the fronts of one version and the direction in which they hand on.
///
/// The tree of components has no up and down by nature: any component can be the last one, and every other then hands
/// on to its neighbour on the way there. So the last one is put where elements change. Far from there nothing then
/// depends on a change, and only when the last component moves is the path between its two places factored again. With
/// the last one fixed at the top separator every change would factor the largest fronts again, which in a plate are a
/// good part of the whole.

#include "linalg/front.h"
#include "linalg/front_tree.h"

namespace rhexis::linalg {

/// Which way fronts hand on, for one last component.
struct Direction {
  std::int32_t last = -1;
  std::vector<std::int32_t> next;   ///< per component, to whom it hands on; -1: the last
  std::vector<std::int32_t> order;  ///< all components, each after those that hand on to it
  /// All components from the last one outwards: those of a level hand on to the level before, and to nobody else.
  std::vector<std::int32_t> by_level;
  std::vector<std::int32_t> level_start;  ///< levels + 1 offsets into by_level

  [[nodiscard]] std::size_t levels() const { return level_start.size() - 1; }
  [[nodiscard]] std::span<const std::int32_t> level(std::size_t k) const {
    return std::span(by_level).subspan(static_cast<std::size_t>(level_start[k]),
                                       static_cast<std::size_t>(level_start[k + 1] - level_start[k]));
  }
};

[[nodiscard]] Direction direct(const ComponentTree& tree, std::int32_t last);

struct FrontTree::Core {
  class Backward;

  explicit Core(FrontLayout with) : layout(std::move(with)) {}

  FrontLayout layout;
  std::vector<std::int32_t> kept;  // nodes, ascending
  std::vector<NodeKey> kept_keys;  // the same, ascending
  Direction direction;
  std::vector<std::shared_ptr<const Front>> fronts;  // by component; null after one that is not positive definite
  double null_pivot = 0.0;

  FrontOutcome outcome = FrontOutcome::ok;
  std::vector<std::int32_t> kept_dofs;
  Eigen::MatrixXd schur;
  VectorX schur_load;
  double load_energy = 0.0;
  std::size_t made = 0;
  double flops = 0.0;

  [[nodiscard]] const Front* front(std::int32_t component) const {
    return fronts[static_cast<std::size_t>(component)].get();
  }
  [[nodiscard]] std::int32_t next(std::int32_t component) const {
    return direction.next[static_cast<std::size_t>(component)];
  }
  /// Nodes that elements on both sides of the step from a component to the next one touch; empty for the last.
  [[nodiscard]] std::span<const NodeKey> beyond(std::int32_t component) const;
  /// The front that eliminates the node; -1: none.
  [[nodiscard]] std::int32_t find_front(std::int32_t node) const;

  /// The components and all that come after them, each after those that hand on to it.
  [[nodiscard]] std::vector<std::int32_t> paths_from(const std::vector<std::int32_t>& components) const;
  void check_solvable(const VectorX& x_kept) const;

  void set_kept(const std::vector<std::int32_t>& nodes);
  /// Makes the fronts that are marked and all after them.
  void factor(const ElementSource& source, std::vector<char> marked);
  void condense(const ElementSource& source);
  /// An update holds the fronts that it replaces until it is done. What the dearest needs beside them is taken from the
  /// system now, with its pages, and left to the pool.
  void lay_in_blocks() const;
};

}  // namespace rhexis::linalg
