#pragma once

/// In one topology, and with the same nodes held, all is linear in the forces on these: the displacement under new
/// forces is the sum of what is known already, and only forces out of the span of earlier ones are solved for.

#include <functional>

#include <Eigen/Core>

#include "base/vec.h"

namespace rhexis::response {

class ForceBasis {
 public:
  /// Displacement (m, of whichever nodes) under forces on the held nodes (N) and `loads` times the loads.
  using Solve = std::function<void(const VectorX& held_forces, double loads, VectorX& out)>;

  /// When the topology or the held nodes have changed.
  void clear() { known_ = false; }
  /// The same forces again give the same bits.
  void displacement(const VectorX& held_forces, const Solve& solve, VectorX& out);

 private:
  bool known_ = false;
  VectorX rest_;           ///< m, by the loads alone
  Eigen::MatrixXd force_;  ///< orthogonal columns of length 1
  Eigen::MatrixXd moved_;  ///< m/N, by each of them
};

}  // namespace rhexis::response
