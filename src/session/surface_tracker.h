#pragma once

/// The surface of a torn body as clients hold it: vertices in slots that are never given up, face slots that an edit
/// empties and fills again (schema/rhexis.fbs). Followed edit by edit, at the cost of what changed. Frozen pieces are
/// out of the solve but not out of sight: their surface is here too.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "mesh/torn_mesh.h"

namespace rhexis::session {

/// What one edit did to the surface. Slots are named once each.
struct SurfaceChange {
  std::vector<std::uint32_t> moved;   ///< vertices that were there before and moved
  std::uint32_t first_new = 0;        ///< vertices from here on are new
  std::vector<std::uint32_t> gone;    ///< face slots that are empty now and were not
  std::vector<std::uint32_t> filled;  ///< face slots that have other corners than before
};

class SurfaceTracker {
 public:
  /// Vertices in the order of their nodes, faces in the order of (tet, vertex).
  explicit SurfaceTracker(const mesh::TornMesh& body);

  /// After `body` has taken `edit`. One that gives an edit back is tracked anew.
  SurfaceChange follow(const mesh::TornMesh& body, const mesh::MeshEdit& edit);

  /// Per vertex slot.
  [[nodiscard]] const std::vector<NodeId>& nodes() const { return node_; }
  /// Per face slot: 3 vertices, counter-clockwise from outside; three times the same: empty.
  [[nodiscard]] const std::vector<std::array<std::uint32_t, 3>>& faces() const { return faces_; }
  [[nodiscard]] bool is_empty(std::uint32_t slot) const { return !tet_[slot].tet.valid(); }
  /// Of a slot that is not empty.
  [[nodiscard]] mesh::TetFace face(std::uint32_t slot) const { return tet_[slot]; }
  /// Empty for a face that is not on the surface.
  [[nodiscard]] std::optional<std::uint32_t> slot_of(mesh::TetFace face) const;
  /// Empty for a node that was never on it.
  [[nodiscard]] std::optional<std::uint32_t> vertex_of(NodeId node) const;
  /// Slots of the faces that these tets have on the surface, in the order of the tets.
  void add_slots_of(std::span<const TetId> tets, std::vector<std::uint32_t>& slots) const;

 private:
  std::uint32_t vertex_for(NodeId node);
  void fill(std::uint32_t slot, const mesh::TornMesh& body, mesh::TetFace face);

  std::vector<NodeId> node_;          ///< per vertex
  std::vector<std::int32_t> vertex_;  ///< per node; -1: none
  std::vector<mesh::TetFace> tet_;    ///< per face slot; an invalid tet: empty
  std::vector<std::array<std::uint32_t, 3>> faces_;
  std::vector<std::int32_t> slot_;   ///< per face of a tet, 4 a tet; -1: none
  std::vector<std::uint32_t> free_;  ///< slots that are empty; the last one is filled next
};

/// No other tet that is alive shares this face of one that is.
[[nodiscard]] bool is_on_surface(const mesh::TornMesh& body, mesh::TetFace face);

}  // namespace rhexis::session
