#pragma once

/// Nothing is left half-written: a file appears under its own name only when it is complete.

#include <filesystem>
#include <functional>
#include <string_view>

#include "base/error.h"

namespace rhexis {

/// Calls write(temporary) with a name in the same folder, then renames it to `path`. When write fails the temporary is
/// removed and `path` stays as it was. The folder is made when it is missing.
Expected<void> write_atomically(const std::filesystem::path& path,
                                const std::function<Expected<void>(const std::filesystem::path& temporary)>& write);

/// The same for contents that are in memory.
Expected<void> write_atomically(const std::filesystem::path& path, std::string_view contents);

/// A program that is killed leaves its temporary behind. The name of the file that it would have become, without
/// folder; `name` itself when it is not that of a temporary.
[[nodiscard]] std::string_view finished_name(std::string_view name);

}  // namespace rhexis
