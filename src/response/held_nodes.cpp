#include "response/held_nodes.h"

#include <algorithm>
#include <utility>

namespace rhexis::response {
namespace {

using linalg::FrontTree;

enum class Place { nowhere, outside, inside, rim };

Place place_of(const mesh::TornMesh& mesh, const Halves& halves, NodeId node) {
  const auto around = mesh.tets_around(node);
  const auto found = std::find_if(around.begin(), around.end(), [&](TetId tet) { return mesh.is_solved(tet); });
  if (found == around.end()) return Place::nowhere;
  if (halves.window->is_on_rim(node)) return Place::rim;
  return halves.window->holds(*found) ? Place::inside : Place::outside;
}

/// Rows of the identity, for the dofs that one of the trees eliminates.
struct UnitForces {
  std::vector<std::int32_t> dof;
  std::vector<Eigen::Index> column;

  [[nodiscard]] FrontTree::Forward solve(const FrontTree& tree, Eigen::Index columns) const {
    Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(dof.size()), columns);
    for (std::size_t i = 0; i < dof.size(); ++i) rows(static_cast<Eigen::Index>(i), column[i]) = 1.0;
    return tree.forward(dof, rows);
  }
};

}  // namespace

HeldNodes solve_held_nodes(const mesh::TornMesh& mesh, const ElasticModel& model, const Halves& halves,
                           const RimSystem& rim, std::vector<NodeId> nodes, const HeldNodes& before) {
  const auto columns = static_cast<Eigen::Index>(3 * nodes.size());
  HeldNodes out;
  out.in_solve = true;
  out.rest = VectorX::Zero(columns);
  out.compliance = Eigen::MatrixXd::Zero(columns, columns);
  out.at_rim = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(rim.dofs().size()), columns);
  UnitForces outside;
  UnitForces inside;
  for (Eigen::Index column = 0; column < columns; ++column) {
    const NodeId node = nodes[static_cast<std::size_t>(column / 3)];
    const auto dof = static_cast<std::int32_t>(3 * node.value() + column % 3);
    const Place place = place_of(mesh, halves, node);
    if (place == Place::nowhere) {
      out.in_solve = false;
      continue;
    }
    const auto intact = 3 * mesh.original(node).index() + static_cast<std::size_t>(column % 3);
    if (model.held[intact] != 0) {
      out.rest[column] = model.value[static_cast<Eigen::Index>(intact)];
      continue;
    }
    if (place == Place::rim) {
      out.at_rim(rim.place(dof), column) = 1.0;
    } else {
      UnitForces& forces = place == Place::inside ? inside : outside;
      forces.dof.push_back(dof);
      forces.column.push_back(column);
    }
  }

  const auto add = [&](const FrontTree::Forward& forward) {
    out.compliance += forward.gram;
    out.rest += forward.with_load;
  };
  if (!outside.dof.empty()) {
    // While fronts run on inside their window this is the same as before, and it is the dear one.
    const bool is_same =
        before.outside_tree == halves.outside && before.nodes == nodes && before.outside.gram.cols() == columns;
    out.outside = is_same ? before.outside : outside.solve(*halves.outside, columns);
    out.outside_tree = halves.outside;
    rim.add_outside(out.outside.kept, out.at_rim);
    add(out.outside);
  }
  if (!inside.dof.empty()) {
    out.inside = inside.solve(*halves.inside, columns);
    rim.add_inside(out.inside.kept, out.at_rim);
    add(out.inside);
  }
  rim.forward(out.at_rim);
  out.compliance.noalias() += out.at_rim.transpose() * out.at_rim;
  out.rest.noalias() += out.at_rim.transpose() * rim.load();
  out.nodes = std::move(nodes);
  return out;
}

}  // namespace rhexis::response
