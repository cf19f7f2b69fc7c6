#pragma once

#include <span>
#include <string>
#include <string_view>

namespace rhexis {

/// The candidate with the smallest edit distance to `name` when that is close enough to be a slip of the hand (at most
/// a third of its length, at least 2), else empty. For "unknown key 'younf' (did you mean 'young'?)".
[[nodiscard]] std::string nearest_name(std::string_view name, std::span<const std::string> candidates);

}  // namespace rhexis
