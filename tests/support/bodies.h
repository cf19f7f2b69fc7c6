#pragma once

/// Small loadings that several tests share.

#include <algorithm>
#include <string>

#include "mesh/tet_mesh.h"
#include "model/loading.h"
#include "model/model.h"

namespace rhexis::test {

inline model::Loading no_load(const model::Model& body) {
  model::Loading loading;
  loading.dead_force = VectorX::Zero(static_cast<Eigen::Index>(body.space().dof_count()));
  return loading;
}

/// u_component = value on every node of the set (P2: the middles of its edges too).
inline void hold(model::Loading& loading, const mesh::TetMesh& mesh, const model::Model& body, const std::string& set,
                 int component, double value) {
  for (const std::int32_t node : model::nodes_of_set(body.space(), mesh.find_node_set(set)->nodes))
    loading.supports.push_back({3 * node + component, value});
  std::sort(loading.supports.begin(), loading.supports.end(),
            [](const auto& a, const auto& b) { return a.dof < b.dof; });
}

/// All three components of a set at zero.
inline void clamp(model::Loading& loading, const mesh::TetMesh& mesh, const model::Model& body,
                  const std::string& set) {
  for (int i = 0; i < 3; ++i) hold(loading, mesh, body, set, i, 0.0);
}

/// Symmetry planes of a box: x on -x, y on -y, z on -z.
inline void hold_symmetry(model::Loading& loading, const mesh::TetMesh& mesh, const model::Model& body) {
  hold(loading, mesh, body, "-x", 0, 0.0);
  hold(loading, mesh, body, "-y", 1, 0.0);
  hold(loading, mesh, body, "-z", 2, 0.0);
}

/// Sum of one component of nodal forces over a set, N.
inline double total(const VectorX& force, const model::Model& body, const mesh::TetMesh& mesh, const std::string& set,
                    int component) {
  double sum = 0.0;
  for (const std::int32_t node : model::nodes_of_set(body.space(), mesh.find_node_set(set)->nodes))
    sum += force[3 * node + component];
  return sum;
}

}  // namespace rhexis::test
