#pragma once

/// The pieces that a body has come apart into, and which of them still have support.

#include <cstdint>
#include <vector>

#include "mesh/torn_mesh.h"

namespace rhexis::fracture {

struct Pieces {
  std::vector<std::int32_t> of_tet;     ///< per tet: number of its piece, by the lowest tet in it; -1 when not alive
  std::vector<TetId> first;             ///< per piece: the lowest tet in it; ascending
  std::vector<std::uint8_t> supported;  ///< per piece: no rigid motion is free
  [[nodiscard]] std::size_t count() const { return supported.size(); }
  friend bool operator==(const Pieces&, const Pieces&) = default;
};

/// Tets belong together when they share a face. A piece is supported when the held components of its nodes, and the
/// nodes that it shares with supported pieces, leave it no rigid motion. `held`: 3 per node of the mesh.
[[nodiscard]] Pieces find_pieces(const mesh::TornMesh& body, const std::vector<std::uint8_t>& held);

/// The same after `edit`, which `body` has taken, from the pieces before it. Only what is around the edit is walked,
/// and whatever has come apart except for the largest part of it; all tets only when pieces change their numbers.
/// `held` is as it was but for copied nodes. After TornMesh::undo: find_pieces.
void update_pieces(Pieces& pieces, const mesh::TornMesh& body, const mesh::MeshEdit& edit,
                   const std::vector<std::uint8_t>& held);

/// Tets in the solve whose piece has no support: what MeshEdit::frozen takes. Ascending.
[[nodiscard]] std::vector<TetId> unsupported_tets(const mesh::TornMesh& body, const Pieces& pieces);

}  // namespace rhexis::fracture
