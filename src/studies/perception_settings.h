#pragma once

/// What an experiment on crack angles is told by its file (docs/angle-perception.md): the thesis's where it says
/// nothing.

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "base/vec.h"
#include "scene/declaration.h"
#include "scene/document.h"
#include "studies/perception_rule.h"

namespace rhexis::studies {

/// A value with the place where it was said, for errors that only the body can tell.
struct PlacedVector {
  Vec3 value = Vec3::Zero();
  scene::Place place = {};
};

struct PerceptionSettings {
  std::string title = "Which crack angles a hand can tell apart";
  std::filesystem::path scene;  ///< of the plate; empty: that of the thesis
  std::uint64_t seed = 1;
  int repeats = 2;           ///< runs of each point and direction
  bool interleaved = false;  ///< false: one run after the other
  double sample = 90.0;      ///< degrees, from +x, of the sample's crack
  double length = 0.0403;    ///< m that all cracks have run on by
  RuleSettings rule;
  std::vector<PlacedVector> points;                          ///< m, where the plate is held
  std::vector<PlacedVector> directions;                      ///< unit, along which it is pulled
  std::vector<double> classes{0.0, 15.0, 30.0, 45.0, 60.0};  ///< degrees, where the classes of differences begin

  [[nodiscard]] std::size_t runs() const {
    return points.size() * directions.size() * static_cast<std::size_t>(repeats);
  }
};

/// The sections that an experiment's file may have.
[[nodiscard]] std::span<const scene::Section> perception_sections();

/// Errors carry `file` and the line. A scene that it names is relative to it.
[[nodiscard]] Expected<PerceptionSettings> parse_perception(std::string_view text, const std::string& file);
/// An empty path: the experiment of the thesis.
[[nodiscard]] Expected<PerceptionSettings> read_perception(const std::filesystem::path& path);

/// Of all that decides which trials there are, and of the text of the plate's scene: two experiments of one fingerprint
/// and one seed are the same.
[[nodiscard]] std::uint64_t fingerprint_of(const PerceptionSettings& settings);

}  // namespace rhexis::studies
