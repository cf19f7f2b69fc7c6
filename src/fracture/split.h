#pragma once

#include "fracture/cut_geometry.h"
#include "fracture/incision.h"

namespace rhexis::fracture {

/// How far behind an incision its crack is looked at again, in mean edges. A front stands between nodes: the last faces
/// behind it still hang together at their nodes, and come apart when the crack has gone past these.
inline constexpr double kJoinReach = 2.0;

/// The incision that keeps the volume: see incise.
[[nodiscard]] Incision incise_splitting(const mesh::TornMesh& body, const Surroundings& surroundings,
                                        const CutGeometry& surface, const IncisionSettings& settings);

}  // namespace rhexis::fracture
