#pragma once

/// Unit forces on the nodes that the hand holds, solved for as far as the rim, and what they and the loads do there.

#include <memory>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "response/halves.h"
#include "response/rim_system.h"

namespace rhexis::response {

/// Column 3 i + c is the force on component c of node i.
struct HeldNodes {
  std::vector<NodeId> nodes;
  std::shared_ptr<const linalg::FrontTree> outside_tree;  ///< that `outside` was solved with
  linalg::FrontTree::Forward outside;                     ///< of the nodes there; no columns when there are none
  linalg::FrontTree::Forward inside;
  Eigen::MatrixXd at_rim;      ///< L^-1 of what they leave on the rim
  Eigen::MatrixXd compliance;  ///< L_cc, m/N; rows and columns zero where a component is not free
  VectorX rest;                ///< m
  bool in_solve = true;        ///< every node has a tet in the solve
};

/// `before`: of the same nodes or others; what it has of the same outside is taken over.
[[nodiscard]] HeldNodes solve_held_nodes(const mesh::TornMesh& mesh, const ElasticModel& model, const Halves& halves,
                                         const RimSystem& rim, std::vector<NodeId> nodes, const HeldNodes& before);

}  // namespace rhexis::response
