#pragma once

#include <span>

#include "fracture/cut_geometry.h"
#include "fracture/incision.h"

namespace rhexis::fracture {

/// The incision of Nakao et al. 2007, as the thesis has it (4.10)-(4.13): see incise. `near`: tets that hold all
/// candidates, ascending.
[[nodiscard]] Incision incise_keeping_nodes(const mesh::TornMesh& body, const CutGeometry& surface,
                                            const IncisionSettings& settings, std::span<const TetId> near);

}  // namespace rhexis::fracture
