#pragma once

#include <span>

#include "linalg/front.h"

namespace rhexis::linalg {

/// Eliminates the pivots of an assembled front: L_pp, L_bp and y in its panel, U in its update, and whether it is
/// positive definite. `diagonal`: what elements have put on each dof's diagonal; a pivot below `null_pivot` times that
/// is rounding. `may_fork`: spread over threads; the bits are the same either way.
void eliminate_pivots(Front& front, std::span<const double> diagonal, double null_pivot, bool may_fork);

}  // namespace rhexis::linalg
