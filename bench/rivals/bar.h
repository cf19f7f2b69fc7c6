#pragma once

/// The bar that every program is given: 100 x 20 x 20 mm, held at one end, led by a hand at a node of the other.

#include <cstdint>
#include <memory>
#include <vector>

#include "base/error.h"
#include "base/vec.h"
#include "material/parameters.h"
#include "mesh/tet_mesh.h"
#include "model/loading.h"
#include "model/make_model.h"

namespace rhexis::rivals {

/// s, between two places of the hand.
inline constexpr double kFrame = 1.0 / 60.0;

struct Bar {
  mesh::TetMesh mesh;
  material::Elastic elastic;
  std::vector<NodeId> held;  ///< by the support
  NodeId hand;               ///< the node that the hand leads

  static Expected<Bar> make(int nodes, const material::Elastic& elastic);

  [[nodiscard]] Eigen::Index dofs() const { return 3 * static_cast<Eigen::Index>(mesh.node_count()); }
  /// The support, without a hand.
  [[nodiscard]] model::Loading supported() const;
  /// The support, and the hand's node displaced by `hand`, m.
  [[nodiscard]] model::Loading led(const Vec3& hand) const;
  /// beta = "auto" as in play, or none.
  [[nodiscard]] std::shared_ptr<const model::Model> model(model::ModelKind kind, bool stabilised) const;
};

/// The equilibrium with the hand at `hand`, from a state near it: the residual below 1e-9 of the forces, or
/// RHEXIS_CHECK.
[[nodiscard]] model::State converged(const Bar& bar, const model::Model& model, const Vec3& hand, model::State near);

/// |u - of| / |of| over all nodes.
[[nodiscard]] double error_of(const VectorX& u, const VectorX& of);

}  // namespace rhexis::rivals
