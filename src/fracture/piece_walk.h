#pragma once

/// Whether a body comes apart where it was edited, told without walking all of it.

#include <vector>

#include "fracture/pieces.h"

namespace rhexis::fracture {

/// Parts that an edit has cut off: face-connected sets of tets, all but one of what each piece has become; each
/// ascending, in the order of their lowest tets. `seeds` (alive): tets that lost a neighbour, ascending; every part has
/// one. `pieces`: before the edit. The walks from all seeds go on in turn until they have met or a part is complete, so
/// the cost is that of the way around the cut and of the smaller parts.
[[nodiscard]] std::vector<std::vector<TetId>> parts_cut_off(const mesh::TornMesh& body, const Pieces& pieces,
                                                            const std::vector<TetId>& seeds);

}  // namespace rhexis::fracture
