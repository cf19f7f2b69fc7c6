#pragma once

/// What the volumes of the tets say about a state.

#include "base/vec.h"
#include "model/model.h"

namespace rhexis::model {

/// Counts the tets with J <= 0 and names the one of the smallest J; or, where some J is not finite, the first such tet.
/// Positions that are not finite always show in J, which multiplies them all.
[[nodiscard]] Evaluation evaluation_of(const VectorX& J);

}  // namespace rhexis::model
