#include "fracture/pieces.h"

#include <algorithm>

#include "fracture/face_neighbours.h"
#include "fracture/piece_support.h"

namespace rhexis::fracture {

Pieces find_pieces(const mesh::TornMesh& body, const std::vector<std::uint8_t>& held) {
  Pieces pieces;
  pieces.of_tet.assign(body.mesh().tet_count(), -1);
  std::vector<TetId> open;
  for (std::size_t tet = 0; tet < body.mesh().tet_count(); ++tet) {
    if (!body.is_alive(TetId(tet)) || pieces.of_tet[tet] >= 0) continue;
    const auto piece = static_cast<std::int32_t>(pieces.first.size());
    pieces.first.emplace_back(tet);
    pieces.of_tet[tet] = piece;
    open.assign(1, TetId(tet));
    while (!open.empty()) {
      const TetId at = open.back();
      open.pop_back();
      for (std::int8_t k = 0; k < 4; ++k) {
        const TetId next = tet_across(body, {at, k});
        if (!next.valid() || pieces.of_tet[next.index()] >= 0) continue;
        pieces.of_tet[next.index()] = piece;
        open.push_back(next);
      }
    }
  }
  pieces.supported = find_support(body, pieces, held);
  return pieces;
}

std::vector<TetId> unsupported_tets(const mesh::TornMesh& body, const Pieces& pieces) {
  std::vector<TetId> tets;
  if (std::find(pieces.supported.begin(), pieces.supported.end(), 0) == pieces.supported.end()) return tets;
  for (std::size_t tet = 0; tet < pieces.of_tet.size(); ++tet) {
    const std::int32_t piece = pieces.of_tet[tet];
    if (piece >= 0 && pieces.supported[static_cast<std::size_t>(piece)] == 0 && body.is_solved(TetId(tet)))
      tets.emplace_back(tet);
  }
  return tets;
}

}  // namespace rhexis::fracture
