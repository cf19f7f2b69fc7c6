#pragma once

#include "fracture/pieces.h"

namespace rhexis::fracture {

/// What Pieces::supported holds, from Pieces::of_tet and `first`. See find_pieces.
[[nodiscard]] std::vector<std::uint8_t> find_support(const mesh::TornMesh& body, const Pieces& pieces,
                                                     const std::vector<std::uint8_t>& held);

/// Pieces that have a tet around the node; ascending.
[[nodiscard]] std::vector<std::int32_t> pieces_around(const mesh::TornMesh& body, const Pieces& pieces, NodeId node);

}  // namespace rhexis::fracture
