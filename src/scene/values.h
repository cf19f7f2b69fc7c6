#pragma once

/// A scene that matches the declaration: every value has the declared form and range, defaults are filled in.

#include <array>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "base/check.h"
#include "base/vec.h"
#include "scene/declaration.h"
#include "scene/document.h"

namespace rhexis::scene {

/// Metres, or a fraction of the body's box in the direction it is asked for.
struct Length {
  double value = 0.0;
  bool relative = false;
};

/// Fractions of the bounding box.
struct Box {
  Vec3 from = Vec3::Zero();
  Vec3 to = Vec3::Ones();
};

/// "auto" of number_or_auto is the std::string.
using Value = std::variant<bool, std::int64_t, double, std::string, Vec3, std::vector<std::int64_t>,
                           std::vector<double>, Length, Box>;

struct Setting {
  Value value;
  Place place;
  bool given = false;  ///< false: the declared default
};

/// One section, or one entry of a list or of named sections.
struct SectionValues {
  const Section* section = nullptr;
  std::string name;  ///< of a named section: "top"
  std::string path;  ///< "material", "sets.top", "support.0"; empty for the root
  Place place;       ///< of its header; of the file when the section is left out
  bool given = false;
  std::map<std::string, Setting, std::less<>> settings;

  [[nodiscard]] bool given_key(std::string_view key) const {
    const auto found = settings.find(key);
    return found != settings.end() && found->second.given;
  }
  /// nullptr when the key was left out and has no default. The key must be declared.
  [[nodiscard]] const Setting* find(std::string_view key) const {
    RHEXIS_CHECK(section->find(key) != nullptr, "key '{}' of '{}' is not declared", key, section->name);
    const auto found = settings.find(key);
    return found == settings.end() ? nullptr : &found->second;
  }
  /// The value of a key that is required, given or has a default, in its declared form.
  template <class T>
  [[nodiscard]] const T& get(std::string_view key) const {
    const Setting* setting = find(key);
    RHEXIS_CHECK(setting != nullptr && std::holds_alternative<T>(setting->value), "key '{}' of '{}'", key, path);
    return std::get<T>(setting->value);
  }
  [[nodiscard]] Place place_of(std::string_view key) const {
    const Setting* setting = find(key);
    return setting != nullptr && setting->given ? setting->place : place;
  }
  /// "support.0.set", as `--set` names it.
  [[nodiscard]] std::string path_of(std::string_view key) const {
    return path.empty() ? std::string(key) : path + '.' + std::string(key);
  }
};

struct Values {
  Place file;                                                               ///< of the scene, without a line
  std::map<std::string, std::vector<SectionValues>, std::less<>> sections;  ///< single ones and the root have one entry

  /// Of the root ("") or a single section.
  [[nodiscard]] const SectionValues& one(std::string_view section) const { return all(section).front(); }
  [[nodiscard]] const std::vector<SectionValues>& all(std::string_view section) const {
    const auto found = sections.find(section);
    RHEXIS_CHECK(found != sections.end(), "section '{}' is not declared", section);
    return found->second;
  }
};

/// Holds a tree against a declaration, whose first section is the root: that of a scene, or of another file of the same
/// form. The first mistake in the order of the document is the error.
[[nodiscard]] Expected<Values> validate(const Node& root, std::span<const Section> sections = scene_sections());
/// Of a scene's text with the arguments of `--set` applied in order. `file` stands in the errors.
[[nodiscard]] Expected<Values> parse_values(std::string_view text, const std::string& file,
                                            const std::vector<std::string>& overrides);

}  // namespace rhexis::scene
