#pragma once

#include "fracture/cut_geometry.h"
#include "fracture/incision.h"

namespace rhexis::fracture {

/// The incision of Nakao et al. 2007, as the thesis has it (4.10)-(4.13): see incise.
[[nodiscard]] Incision incise_keeping_nodes(const mesh::TornMesh& body, const Surroundings& surroundings,
                                            const CutGeometry& surface, const IncisionSettings& settings);

}  // namespace rhexis::fracture
