#pragma once

/// docs/reproduction.md: every published number beside ours, from what the studies left.

#include <filesystem>
#include <string>

#include "base/error.h"

namespace rhexis::studies {

/// `folder` holds the study.json of each study as NAME.json, or in a folder NAME. A number whose study is not there, or
/// did not measure it, is on the page as not measured. Errors: a file that is no study.json.
[[nodiscard]] Expected<std::string> reproduction_markdown(const std::filesystem::path& folder);

}  // namespace rhexis::studies
