#pragma once

/// A body while cracks run through it: its mesh, the pieces that it has come apart into and the grid around its fronts,
/// kept in step edit by edit. A value: a copy goes its own way.

#include <cstdint>
#include <span>
#include <vector>

#include "fracture/front_surroundings.h"
#include "fracture/incision.h"
#include "fracture/pieces.h"
#include "mesh/torn_mesh.h"

namespace rhexis::fracture {

class TornBody {
 public:
  /// `held_dofs`: dofs of the intact body (3 node + component) that a support gives. All incisions are by `method`.
  TornBody(const mesh::TetMesh& intact, std::span<const std::int32_t> held_dofs, IncisionMethod method);

  [[nodiscard]] const mesh::TornMesh& mesh() const { return mesh_; }
  [[nodiscard]] const Surroundings& surroundings() const { return surroundings_; }
  [[nodiscard]] double mean_edge() const { return surroundings_.mean_edge(); }  ///< m, of the intact body
  [[nodiscard]] std::size_t pieces() const { return pieces_.count(); }
  /// Per node, copies too: a support gives some component of its displacement.
  [[nodiscard]] const std::vector<std::uint8_t>& supported() const { return supported_; }
  /// Nodes with a support and those in the hand stay where they are.
  [[nodiscard]] IncisionSettings incision_settings(std::span<const NodeId> in_hand = {}) const;

  /// Takes the edit, with the pieces that it leaves without support frozen.
  void apply(mesh::MeshEdit edit);
  /// Gives the last edit back. There must be one.
  mesh::MeshEdit undo();

 private:
  void follow_nodes();

  mesh::TornMesh mesh_;
  Surroundings surroundings_;
  IncisionMethod method_;
  double smallest_radius_ratio_;         ///< of the intact body
  std::vector<std::uint8_t> held_;       ///< 3 per node, copies too
  std::vector<std::uint8_t> supported_;  ///< per node, copies too
  Pieces pieces_;
};

}  // namespace rhexis::fracture
