#pragma once

/// Where cracks will run if they run straight on. An update of the factor costs what the separators cost along which it
/// goes; a crack that runs along a large one pays for it with every advance, one that crosses it pays once. So a
/// dissection that knows the corridor lets separators cross it, and keeps them from lying in it.

#include <cstdint>
#include <span>
#include <vector>

#include "mesh/torn_mesh.h"
#include "response/response.h"

namespace rhexis::response {

/// Half the width of the corridor in mean edges, and what a node in it weighs in a separator; measured:
/// docs/exact-response.md.
inline constexpr double kCorridorEdges = 3.0;
inline constexpr std::int32_t kCorridorWeight = 5;

/// Per node of the body; 1 outside.
[[nodiscard]] std::vector<std::int32_t> separator_weights(const mesh::TornMesh& body, std::span<const Focus> focus);

/// Nodes ahead of the fronts, ascending, where the next edits will be: within half the radius of the local object. A
/// front whose direction is not known has none.
[[nodiscard]] std::vector<std::int32_t> nodes_ahead(const mesh::TornMesh& body, std::span<const Focus> focus);

}  // namespace rhexis::response
