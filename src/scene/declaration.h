#pragma once

/// What a scene may say, declared once: validation, docs/scene.md, the JSON Schema for editors and the page's sliders
/// all come from these tables.

#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace rhexis::scene {

/// The form of a value.
enum class Kind {
  boolean,
  integer,
  number,  ///< integers are numbers too
  text,
  file,            ///< a file name, relative to the scene
  choice,          ///< one of `names`
  set,             ///< the name of a node or face set
  vector,          ///< three numbers
  indices,         ///< a list of integers
  numbers,         ///< a list of numbers
  number_or_auto,  ///< a number or "auto"
  length,          ///< metres, or "50%" of the body's box in the direction of the component
  box,             ///< { from = [...], to = [...] }, fractions of the bounding box
};

/// Of a number; of each entry for vectors, lists and boxes; of the number or percentage for lengths.
struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool min_open = false;  ///< min itself is out
  bool max_open = false;

  [[nodiscard]] bool holds(double value) const;  ///< false for NaN and infinities
  [[nodiscard]] bool is_everything() const;
};
[[nodiscard]] constexpr Range at_least(double min) { return {.min = min}; }
[[nodiscard]] constexpr Range within(double min, double max) { return {.min = min, .max = max}; }
[[nodiscard]] constexpr Range strictly_within(double min, double max) {
  return {.min = min, .max = max, .min_open = true, .max_open = true};
}
/// "more than 0", "more than -1 and less than 0.5", "1 to 100"; empty for every number.
[[nodiscard]] std::string text_of(const Range& range);

struct Key {
  std::string name{};
  Kind kind = Kind::number;
  std::string unit{};  ///< SI; empty: none
  Range range{};
  std::string fallback{};            ///< the default as TOML; empty: none
  std::string otherwise{};           ///< what leaving it out means, where no default says it
  std::vector<std::string> names{};  ///< of a choice
  bool required = false;
  std::string doc{};  ///< one line
};

enum class SectionForm {
  root,    ///< keys before the first section
  single,  ///< [material]
  named,   ///< [sets.NAME], any number
  list,    ///< [[support]], any number
};

struct Section {
  std::string name{};
  SectionForm form = SectionForm::single;
  bool required = false;
  std::vector<std::string> exactly_one{};  ///< of these keys one is given, and only one
  std::string doc{};
  std::vector<Key> keys{};

  [[nodiscard]] const Key* find(std::string_view key) const;  ///< nullptr: no such key
};

/// All sections, in the order in which the reference shows them; the root is the first.
[[nodiscard]] std::span<const Section> scene_sections();
/// nullptr: no such section.
[[nodiscard]] const Section* find_section(std::string_view name);

/// "[material]", "[sets.NAME]", "[[support]]".
[[nodiscard]] std::string header_of(const Section& section);
/// What a value should be: "a number in Pa, more than 0", "one of "direct", "cg", "minres"".
[[nodiscard]] std::string wanted(const Key& key);

}  // namespace rhexis::scene
