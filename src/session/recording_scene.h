#pragma once

/// A scene as a recording keeps it: name, text, what was set, its mesh file and which record, as bytes.

#include <cstdint>
#include <span>
#include <vector>

#include "session/open_body.h"

namespace rhexis::session {

[[nodiscard]] std::vector<std::uint8_t> bytes_of(const SceneChoice& scene);
/// Errors: not such bytes.
[[nodiscard]] Expected<SceneChoice> parse_scene_choice(std::span<const std::uint8_t> bytes);

}  // namespace rhexis::session
