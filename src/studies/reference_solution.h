#pragma once

/// Equilibria by other programs that may lie beside the checkout, with the meshes they are of. They are not part of the
/// project: where there are none, a study says so and goes on.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "studies/loaded_body.h"

namespace rhexis::studies {

/// The vessel of `shared`/reference/4_vessel_small, loaded as make_vessel; empty when it is not there. Errors: a file
/// of it that cannot be read.
[[nodiscard]] Expected<std::optional<LoadedBody>> read_reference_vessel(const std::filesystem::path& shared);

/// One displacement per node, m, of a CSV file `ux,uy,uz` in 3 * node + component; empty when it is not there. Errors:
/// no such numbers, or not 3 per node.
[[nodiscard]] Expected<std::optional<VectorX>> read_displacement(const std::filesystem::path& file, std::size_t nodes);

}  // namespace rhexis::studies
