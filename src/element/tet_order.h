#pragma once

/// In which order the tets are visited, and which of them may be added at the same time.

#include <cstdint>
#include <vector>

#include "mesh/tet_mesh.h"

namespace rhexis::element {

/// Chunks of tets in the order in which their sums are added up.
struct TetOrder {
  std::vector<std::int32_t> tets;        ///< all tets, chunk by chunk
  std::vector<std::size_t> chunk_start;  ///< chunks + 1 offsets into `tets`, chunks ordered by colour
  std::vector<std::size_t>
      colour_start;  ///< colours + 1 offsets into the chunks; no two chunks of a colour share a node
};

/// Chunks are slices of the breadth-first levels of the mesh: a slice meets the slice before and the one after it
/// alone, so that two colours do where the levels are small, and neighbours in memory are neighbours in space. Levels
/// larger than a chunk are cut, at the price of a few more colours. Depends on the mesh alone.
[[nodiscard]] TetOrder order_tets(const mesh::TetMesh& mesh);

}  // namespace rhexis::element
