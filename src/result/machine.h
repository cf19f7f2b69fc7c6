#pragma once

/// Where numbers were measured: times mean nothing without.

#include <nlohmann/json.hpp>

namespace rhexis::result {

/// `processor`, `cores` (that this process may use), `instruction_set` (of the kernels), `memory_GB`, `system`. Nothing
/// that names its owner.
[[nodiscard]] nlohmann::ordered_json machine();

}  // namespace rhexis::result
