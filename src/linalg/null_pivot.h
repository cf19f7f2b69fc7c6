#pragma once

#include <algorithm>

namespace rhexis::linalg {

/// What cancellation leaves of a scaled diagonal entry below this is rounding, and the matrix of `unknowns` rows
/// singular. The last pivot of a free motion v (|v| = 1) is its eigenvalue, rounding, over v_i^2, that is, times the
/// unknowns: boxes of 200 to 13,000 free unknowns leave 1e-14 to 8e-13. Bodies that are held leave 1e-2 and a slender
/// rod of five hundred elements, whose smallest eigenvalue is 1e-11, should leave some 1e-8 (an estimate).
[[nodiscard]] inline double null_pivot(int unknowns) { return std::max(1e-13, 2e-15 * unknowns); }

}  // namespace rhexis::linalg
