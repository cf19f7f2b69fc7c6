#pragma once

/// What is left when everything but the rim has been eliminated: S = S_outside + S_inside on the rim's dofs, factored.

#include <vector>

#include <Eigen/Core>

#include "linalg/front_tree.h"

namespace rhexis::response {

/// Empty until `factor`, which may be called again and takes no new memory then for a rim of the same size.
class RimSystem {
 public:
  /// `inside` may be null: there is no rim then, and all that follows is empty. False: S is not positive definite, the
  /// body has a free motion, and this is of no use until the next.
  [[nodiscard]] bool factor(const linalg::FrontTree& outside, const linalg::FrontTree* inside);

  /// Dofs of the rim that are in the assembly, ascending.
  [[nodiscard]] const std::vector<std::int32_t>& dofs() const { return dofs_; }
  /// Place of a dof among them, -1.
  [[nodiscard]] Eigen::Index place(std::int32_t dof) const;
  /// L^-1 (what the loads leave on the rim).
  [[nodiscard]] const VectorX& load() const { return load_; }

  /// Adds what a forward solution leaves on the kept dofs of either tree, rows by dofs().
  void add_outside(const Eigen::MatrixXd& kept, Eigen::MatrixXd& to) const;
  void add_inside(const Eigen::MatrixXd& kept, Eigen::MatrixXd& to) const;
  /// In place: L^-1 b and L^-T y.
  void forward(Eigen::MatrixXd& b) const;
  void backward(VectorX& y) const;
  /// Of the kept dofs of either tree.
  [[nodiscard]] VectorX at_outside(const VectorX& x) const;
  [[nodiscard]] VectorX at_inside(const VectorX& x) const;

  [[nodiscard]] std::size_t memory_bytes() const;

 private:
  std::vector<std::int32_t> dofs_;
  std::vector<int> outside_;  ///< per kept dof of that tree, its place in dofs_
  std::vector<int> inside_;
  Eigen::MatrixXd L_;  ///< lower triangle of the factor; what is above is not read
  VectorX load_;
  std::vector<double> work_;
};

}  // namespace rhexis::response
