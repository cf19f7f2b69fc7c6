#pragma once

/// The constant data of eight tets side by side (AoSoA), as the kernels read it: plain arrays, no code.

#include <cstdint>

namespace rhexis::element {

inline constexpr int kBatch = 8;  ///< one AVX-512 register, two of AVX2, four of SSE2

/// Lanes from `count` on repeat lane 0 with volume 0 and are never written back. The four nodes of a lane ascend, so
/// that block (a, b) with a >= b lies in the lower triangle; nothing here depends on the orientation.
struct alignas(64) TetBatch {
  double gradient[9][kBatch];    ///< of the shape functions of local nodes 1, 2, 3: x y z each, 1/m; node 0 has minus
                                 ///< their sum
  double volume[kBatch];         ///< m^3
  std::int32_t node[4][kBatch];  ///< ascending
  std::int32_t tet[kBatch];      ///< index in the mesh
  std::int32_t count;            ///< tets in this batch, 1 to 8
};

/// Where the ten blocks of each tet lie in SymmetricBlockMatrix::values, as indices of blocks: local pairs (0,0),
/// (1,0), (1,1), (2,0), ... (3,3).
struct alignas(64) BlockPlaces {
  std::int32_t block[10][kBatch];
};

}  // namespace rhexis::element
