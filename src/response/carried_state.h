#pragma once

/// The state of a body of large strain when a crack has run on through its reference configuration: what it starts from
/// there. Copies of a node are where the node is. A node whose reference position moved is where the material of the
/// new one was.

#include <cstdint>
#include <optional>
#include <vector>

#include "mesh/torn_mesh.h"
#include "model/model.h"

namespace rhexis::response {

/// A tet that a cut leaves with less of its volume than this part is opened again, if its nodes can.
inline constexpr double kLeastVolumeLeft = 0.05;

/// `before`: the space of the model before the edit, with the tets that were out of it then; `state`: in it. `mesh` has
/// taken the edit. Empty: some tet in the solve would be inside out, and `may_invert` does not allow that.
[[nodiscard]] std::optional<model::State> carried_state(const model::DisplacementSpace& before,
                                                        const std::vector<std::uint8_t>& left_out_before,
                                                        const model::State& state, const mesh::TornMesh& mesh,
                                                        const mesh::MeshEdit& edit, bool may_invert);

}  // namespace rhexis::response
