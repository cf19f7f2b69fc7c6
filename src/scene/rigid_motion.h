#pragma once

/// The rigid motions that supports leave a body, by name.

#include <string>
#include <vector>

#include "base/vec.h"
#include "model/rigid_motion.h"

namespace rhexis::scene {

/// "translation along y", "rotation about an axis along z through (0, 0.005, 0)", ...; empty when there is none.
/// `centre` and `size` (a length) are of the body, m.
[[nodiscard]] std::vector<std::string> free_rigid_motions(const std::vector<model::HeldComponent>& held,
                                                          const Vec3& centre, double size);

}  // namespace rhexis::scene
