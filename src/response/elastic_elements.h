#pragma once

/// The tets of a torn body of small strains as the front tree reads them.

#include <cstdint>
#include <vector>

#include "linalg/front_tree.h"
#include "material/parameters.h"
#include "mesh/torn_mesh.h"
#include "model/loading.h"

namespace rhexis::response {

/// What does not change while the body tears.
struct ElasticBody {
  material::Elastic elastic;
  double density = 0.0;         ///< kg/m^3
  Vec3 gravity = Vec3::Zero();  ///< m/s^2
  /// Of the intact body, ascending by dof; a copy of a node is held as the node is.
  std::vector<model::PrescribedDof> supports;
  /// N, 3 per node of the intact body, or empty. Stays with the node of that number; its copies take none of it, and it
  /// is gone when the node leaves the solve.
  VectorX dead_force;
};

/// The same, ready to be asked.
struct ElasticModel {
  ElasticModel(ElasticBody of, std::size_t intact_nodes);
  ElasticBody body;
  std::vector<std::uint8_t> held;  ///< 3 per intact node
  VectorX value;                   ///< m, 3 per intact node, zero where free
  bool moves_supports = false;     ///< some value is not zero
};

class ElasticElements final : public linalg::ElementSource {
 public:
  /// Both outlive this.
  ElasticElements(const mesh::TornMesh& mesh, const ElasticModel& model);

  [[nodiscard]] std::int32_t node_count() const override;
  [[nodiscard]] std::int32_t element_count() const override;
  [[nodiscard]] bool is_active(std::int32_t element) const override;
  [[nodiscard]] std::array<std::int32_t, 4> nodes(std::int32_t element) const override;
  void stiffness(std::int32_t element, linalg::ElementMatrix& out) const override;
  /// rho g V / 4 at each corner, minus what the prescribed displacements of the corners take: K_e u_held.
  void load(std::int32_t element, linalg::ElementVector& out) const override;
  [[nodiscard]] Vec3 node_load(std::int32_t node) const override;
  [[nodiscard]] unsigned free_components(std::int32_t node) const override;

 private:
  const mesh::TornMesh& mesh_;
  const ElasticModel& model_;
};

/// 1/2 u K_e u - f_e u over all tets in the solve for u that is prescribed at the supports and zero elsewhere, J: what
/// the potential energy has beside the part of the free dofs.
[[nodiscard]] double support_energy(const mesh::TornMesh& mesh, const ElasticModel& model);

/// 1/2 u K u - f u of all tets in the solve with the displacement `u` (m, 3 per node), J; f: weights and dead forces.
[[nodiscard]] double potential_energy(const mesh::TornMesh& mesh, const ElasticModel& model, const VectorX& u);

}  // namespace rhexis::response
