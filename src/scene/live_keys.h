#pragma once

/// What of a scene can be changed while someone holds its body: for the page's panel, as JSON, from the declaration.

#include <string>
#include <vector>

#include "base/error.h"

namespace rhexis::scene {

/// A list of {key, kind, unit, min, max, choices, doc, otherwise}: `key` as `--set` names it; kind "number", "integer",
/// "boolean" or "choice"; what does not apply is left out.
[[nodiscard]] std::string live_keys_json();
/// The value of each of those keys, as JSON; null where it is left out and has no default. Errors are the scene's.
[[nodiscard]] Expected<std::string> live_values_json(const std::string& text, const std::string& file,
                                                     const std::vector<std::string>& overrides);

}  // namespace rhexis::scene
