#pragma once

#include "scene/values.h"

namespace rhexis::scene {

/// The value of one key in its declared form and range. `path` is the key as `--set` names it.
[[nodiscard]] Expected<Value> value_of(const Key& key, const Node& node, const std::string& path);

/// "(did you mean 'young'?)" or the list of what is known; for a name that is none of them.
[[nodiscard]] std::string suggest(std::string_view name, const std::vector<std::string>& known);

}  // namespace rhexis::scene
