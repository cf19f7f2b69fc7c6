#pragma once

/// What the two papers measured, number by number, so that every study and document takes it from one place.

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

namespace rhexis::studies {

/// A number, or a trend in words where there is none.
struct Published {
  std::string_view id;  ///< begins with the name of the study that measures it: "timing.build.linear"
  std::string_view what;
  std::optional<double> value;  ///< in `unit`
  std::string_view trend;       ///< where there is no value
  std::string_view unit;        ///< empty: none
  std::string_view source;
  [[nodiscard]] std::string_view study() const { return id.substr(0, id.find('.')); }
};

/// In the order of the papers.
[[nodiscard]] std::span<const Published> published_numbers();
/// `id` must be one of them.
[[nodiscard]] const Published& published(std::string_view id);
[[nodiscard]] double published_value(std::string_view id);

/// Ours beside it: what study.json holds of each. `ours`: a number, or words for a trend; null where it was not
/// measured. `why`: where and why the two differ, one sentence.
/// Keys: id, what, unit, published, ours, ratio (of numbers; else null), source, why.
[[nodiscard]] nlohmann::ordered_json beside_published(std::string_view id, const nlohmann::ordered_json& ours,
                                                      const std::string& why);

}  // namespace rhexis::studies
