#pragma once

#include <cstdint>
#include <vector>

#include "linalg/saddle_matrix.h"

namespace rhexis::linalg {

/// Cuts the rows of a symmetric matrix into connected patches of at most `size` rows, breadth first from the first row
/// not yet taken; remainders with fewer than half of that join a neighbour. Rows that no other is coupled to are a
/// patch of their own, the last. Returns the patch of each row, from 0.
[[nodiscard]] std::vector<std::int32_t> cut_into_patches(const CsrPattern& pattern, std::int32_t size);

}  // namespace rhexis::linalg
