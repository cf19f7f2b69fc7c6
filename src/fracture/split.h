#pragma once

#include "fracture/cut_geometry.h"
#include "fracture/incision.h"

namespace rhexis::fracture {

/// The incision that keeps the volume: see incise.
[[nodiscard]] Incision incise_splitting(const mesh::TornMesh& body, const Surroundings& surroundings,
                                        const CutGeometry& surface, const IncisionSettings& settings);

}  // namespace rhexis::fracture
