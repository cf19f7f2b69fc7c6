#pragma once

#include <span>

#include "linalg/front.h"

namespace rhexis::linalg {

/// Eliminates the pivots of an assembled front: L_pp, L_bp and y in its panel, U in its update, and whether it is
/// positive definite. `diagonal`: what elements have put on each dof's diagonal; a pivot below `null_pivot` times that
/// is rounding.
void eliminate_pivots(Front& front, std::span<const double> diagonal, double null_pivot);

}  // namespace rhexis::linalg
