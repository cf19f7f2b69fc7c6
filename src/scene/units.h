#pragma once

/// Length units that a mesh file may be in.

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace rhexis::scene {

struct LengthUnit {
  std::string_view name;
  double metres;  ///< per unit
};

inline constexpr std::array<LengthUnit, 6> kLengthUnits{
    {{"m", 1.0}, {"dm", 1e-1}, {"cm", 1e-2}, {"mm", 1e-3}, {"um", 1e-6}, {"in", 0.0254}}};

[[nodiscard]] inline std::vector<std::string> unit_names() {
  std::vector<std::string> names;
  for (const LengthUnit& unit : kLengthUnits) names.emplace_back(unit.name);
  return names;
}

/// `name` must be one of kLengthUnits.
[[nodiscard]] constexpr double metres_per(std::string_view name) {
  for (const LengthUnit& unit : kLengthUnits)
    if (unit.name == name) return unit.metres;
  return 0.0;
}

}  // namespace rhexis::scene
