#pragma once

/// `--set key=value`: changes to a scene from the command line.

#include <string>
#include <vector>

#include "scene/document.h"

namespace rhexis::scene {

/// Applies one `key=value` to the tree. The key is dotted, entries of lists by their 0-based number (`pull.0.seconds`,
/// `gravity.2`); the value is TOML, or text without its quotes; an empty value takes the key out. Missing tables are
/// made. The place of what is changed becomes `--set key=value`.
[[nodiscard]] Expected<void> apply_override(Node& root, const std::string& override);

}  // namespace rhexis::scene
