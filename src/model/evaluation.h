#pragma once

/// What the models share in judging a state and in showing it by tets.

#include "base/vec.h"
#include "model/model.h"

namespace rhexis::model {

/// Counts the tets with J <= 0 and names the one of the smallest J; or, where some J is not finite, the first such tet.
/// Positions that are not finite always show in J, which multiplies them all.
[[nodiscard]] Evaluation evaluation_of(const VectorX& J);

/// Output alone divides by |J| of a tet, where stress is referred to the current volume; not below this.
inline constexpr double kLeastVolumeRatio = 1e-12;

/// Of the right lengths, all zero.
[[nodiscard]] TetFields make_tet_fields(std::size_t tets);
/// Writes one tet's entries; threads may write different tets at once. `cauchy` in Pa.
void set_tet(TetFields& fields, std::size_t tet, double J, double lambda, const Mat3& cauchy);

}  // namespace rhexis::model
