#pragma once

/// What the declaration says, for people and for editors.

#include <string>

namespace rhexis::scene {

/// docs/scene.md.
[[nodiscard]] std::string scene_reference_markdown();
/// docs/scene.schema.json (JSON Schema, draft 7), which editors with TOML support take for completion and checks.
[[nodiscard]] std::string scene_json_schema();

/// The complete scene that the reference opens with.
[[nodiscard]] std::string scene_reference_example();

}  // namespace rhexis::scene
