#pragma once

/// One topology on its way into a record: what is left of a campaign that was killed. Of this machine's byte order,
/// with a checksum.

#include <cstdint>
#include <filesystem>
#include <optional>

#include "base/error.h"
#include "record/store/record.h"

namespace rhexis::record::build {

/// Whole or not at all. Errors: it cannot be written.
[[nodiscard]] Expected<void> write_part(const std::filesystem::path& path, std::uint64_t fingerprint, int topology,
                                        const store::TopologyData& data);
/// Empty: not there, broken, or not that topology of that record.
[[nodiscard]] std::optional<store::TopologyData> read_part(const std::filesystem::path& path, std::uint64_t fingerprint,
                                                           int topology);

}  // namespace rhexis::record::build
