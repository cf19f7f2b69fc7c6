#pragma once

/// A multifrontal Cholesky factor of an assembly of element matrices that follows a change of a few elements by
/// factoring again only what depends on them: the path of the elimination tree from their fronts to its root (Herholz
/// and Sorkine-Hornung 2020). Some nodes may be kept: they are not eliminated, and what is left on them is the Schur
/// complement of all the rest (static condensation).
///
/// Far from the change nothing is touched, not even the top of the tree, since fronts hand on towards what changed last
/// (front_core.h): of a crack that runs through a plate of 20,000 nodes an advance factors a thousandth of it in the
/// median and a thirtieth in the mean, the crossings of the largest separators included. Kept nodes are carried along
/// those ways, which is nothing for the few that a hand holds and most of the work for a hundred.
///
/// A version never changes; `updated` makes the next one, which shares every front that is the same. So one version can
/// be solved with while another thread makes the next, and going back costs nothing.

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "base/vec.h"

namespace rhexis::linalg {

using ElementMatrix = Eigen::Matrix<double, 12, 12>;
using ElementVector = Eigen::Matrix<double, 12, 1>;

/// The elements as they are now: linear tets of four nodes with three dofs each, dof = 3 node + component.
class ElementSource {
 public:
  virtual ~ElementSource() = default;
  [[nodiscard]] virtual std::int32_t node_count() const = 0;
  [[nodiscard]] virtual std::int32_t element_count() const = 0;
  /// False: not part of the sum.
  [[nodiscard]] virtual bool is_active(std::int32_t element) const = 0;
  [[nodiscard]] virtual std::array<std::int32_t, 4> nodes(std::int32_t element) const = 0;
  virtual void stiffness(std::int32_t element, ElementMatrix& out) const = 0;
  /// Its share of the right-hand side, N; zero when there are no loads.
  virtual void load(std::int32_t element, ElementVector& out) const = 0;
  /// Load at a node beside those of the elements, N.
  [[nodiscard]] virtual Vec3 node_load(std::int32_t node) const = 0;
  /// Bit c: component c of the node's displacement is free; the others are held, and left out.
  [[nodiscard]] virtual unsigned free_components(std::int32_t node) const = 0;
  [[nodiscard]] bool is_free(std::int32_t dof) const { return (free_components(dof / 3) >> (dof % 3) & 1U) != 0; }
};

/// What has happened to the elements since the version that is updated.
struct ElementChange {
  std::vector<std::int32_t> copied;   ///< parent of each appended node
  std::vector<std::int32_t> touched;  ///< elements that came, went, moved or took other nodes
  std::vector<std::int32_t> kept;     ///< the nodes to keep from now on (all of them, ascending)
  /// Nodes about which the next change is expected; empty: where this one was. A guess costs time, not accuracy.
  std::vector<std::int32_t> next;
};

/// What is not a number counts as not positive definite.
enum class FrontOutcome { ok, not_positive_definite };

class FrontTree {
 public:
  /// Orders by nested dissection and factors everything, on all threads. Nodes in `kept` (ascending) must stay kept in
  /// every later version; what is kept only for a time is named in ElementChange::kept. A node without an active
  /// element is left out. `weight`, per node (empty: all 1): how dear the node is in a separator. An update is dear
  /// when what changes lies along a large separator, cheap when it lies across: nodes where changes will come get more.
  /// `next`: as of ElementChange.
  [[nodiscard]] static std::shared_ptr<const FrontTree> make(const ElementSource& elements,
                                                             const std::vector<std::int32_t>& kept,
                                                             std::span<const std::int32_t> weight = {},
                                                             std::span<const std::int32_t> next = {});
  /// The next version. `elements` as after the change.
  [[nodiscard]] std::shared_ptr<const FrontTree> updated(const ElementSource& elements,
                                                         const ElementChange& change) const;
  /// All of it factored again, in the same order: other values of the same elements.
  [[nodiscard]] std::shared_ptr<const FrontTree> refactored(const ElementSource& elements) const;
  ~FrontTree();

  [[nodiscard]] FrontOutcome outcome() const;
  /// The free dofs of the kept nodes that have an active element, ascending.
  [[nodiscard]] const std::vector<std::int32_t>& kept_dofs() const;
  /// The Schur complement of everything else, kept_dofs() squared, both triangles.
  [[nodiscard]] const Eigen::MatrixXd& schur() const;
  /// What the loads leave on kept_dofs() after elimination.
  [[nodiscard]] const VectorX& schur_load() const;
  /// y . y of the loads' forward solution.
  [[nodiscard]] double load_energy() const;

  /// Right-hand sides that are zero at all but a few dofs, as they come out of the forward solve L y = b.
  struct Forward {
    std::vector<std::int32_t> front;  ///< fronts that they reach, children before parents
    std::vector<Eigen::MatrixXd> y;   ///< of those: pivots x columns
    Eigen::MatrixXd kept;             ///< what is left on kept_dofs(), rows x columns
    Eigen::MatrixXd gram;             ///< y^T y over all fronts, columns squared
    VectorX with_load;                ///< y^T (y of the loads), columns
  };
  /// b(dof[i], :) = rows(i, :); dofs free, each in the assembly (a dof that is not is an error: RHEXIS_CHECK).
  [[nodiscard]] Forward forward(std::span<const std::int32_t> dof, const Eigen::MatrixXd& rows) const;

  /// x of all dofs for x on kept_dofs() given, and right-hand side = forward * amount + load * load_amount. Held dofs
  /// and dofs outside the assembly come out zero. Length 3 * node_count at the time of this version.
  void backward(const VectorX& x_kept, const Forward* forward, const VectorX& amount, double load_amount,
                VectorX& x) const;
  /// The same at some nodes alone, bit for bit: only the fronts that lie between them and the last one are solved with,
  /// which is little where elements have changed of late. x has the length above, and other entries of it hold nothing
  /// of meaning afterwards.
  void backward_at(std::span<const std::int32_t> nodes, const VectorX& x_kept, const Forward* forward,
                   const VectorX& amount, double load_amount, VectorX& x) const;

  /// Fronts in all, and those that the last update factored again.
  [[nodiscard]] std::size_t front_count() const;
  [[nodiscard]] std::size_t fronts_made() const;
  [[nodiscard]] double flops_made() const;
  /// Held by this version; what it shares with another is counted in both.
  [[nodiscard]] std::size_t memory_bytes() const;

 private:
  friend class FrontSolver;
  struct Core;
  explicit FrontTree(std::unique_ptr<const Core> core);
  std::unique_ptr<const Core> core_;
};

}  // namespace rhexis::linalg
