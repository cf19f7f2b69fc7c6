#include "scene/declaration.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace rhexis::scene {
namespace {

/// 4000000, 1e15: large bounds are powers of ten, whose noughts nobody counts.
std::string bound_text(double bound) {
  if (std::abs(bound) < 1e7) return fmt::format("{}", bound);
  std::string text = fmt::format("{:g}", bound);
  std::erase(text, '+');
  if (const std::size_t nought = text.find("e0"); nought != std::string::npos) text.erase(nought + 1, 1);
  return text;
}

std::string name_of(const Key& key) {
  switch (key.kind) {
    case Kind::boolean: return "true or false";
    case Kind::integer: return "an integer";
    case Kind::number: return "a number";
    case Kind::text: return "text in quotes";
    case Kind::file: return "a file name in quotes";
    case Kind::choice: {
      std::string text = key.names.size() == 1 ? "" : "one of ";
      for (const std::string& name : key.names) text += (&name == key.names.data() ? "\"" : ", \"") + name + '"';
      return text;
    }
    case Kind::set: return "the name of a set in quotes";
    case Kind::vector: return "three numbers";
    case Kind::indices: return "a list of integers";
    case Kind::numbers: return "a list of numbers";
    case Kind::number_or_auto: return "\"auto\" or a number";
    case Kind::length: return "a number in m, or a percentage of the body's box as \"50%\"";
    case Kind::box: return "{ from = [x, y, z], to = [x, y, z] } in fractions of the bounding box";
  }
  return {};
}

}  // namespace

bool Range::holds(double value) const {
  if (!std::isfinite(value)) return false;
  return (min_open ? value > min : value >= min) && (max_open ? value < max : value <= max);
}

bool Range::is_everything() const { return std::isinf(min) && std::isinf(max); }

std::string text_of(const Range& range) {
  if (range.is_everything()) return {};
  const std::string lower = fmt::format("{} {}", range.min_open ? "more than" : "at least", bound_text(range.min));
  const std::string upper = fmt::format("{} {}", range.max_open ? "less than" : "at most", bound_text(range.max));
  if (std::isinf(range.max)) return lower;
  if (std::isinf(range.min)) return upper;
  if (!range.min_open && !range.max_open) return fmt::format("{} to {}", bound_text(range.min), bound_text(range.max));
  return lower + " and " + upper;
}

const Key* Section::find(std::string_view key) const {
  const auto found = std::find_if(keys.begin(), keys.end(), [&](const Key& k) { return k.name == key; });
  return found == keys.end() ? nullptr : &*found;
}

const Section* find_section(std::string_view name) {
  const std::span<const Section> sections = scene_sections();
  const auto found = std::find_if(sections.begin(), sections.end(), [&](const Section& s) { return s.name == name; });
  return found == sections.end() ? nullptr : &*found;
}

std::string header_of(const Section& section) {
  switch (section.form) {
    case SectionForm::root: return "the scene";
    case SectionForm::single: return '[' + section.name + ']';
    case SectionForm::named: return '[' + section.name + ".NAME]";
    case SectionForm::list: return "[[" + section.name + "]]";
  }
  return {};
}

std::string wanted(const Key& key) {
  std::string text = name_of(key);
  if (!key.unit.empty() && key.kind != Kind::length) text += " in " + key.unit;
  if (const std::string range = text_of(key.range); !range.empty()) {
    const bool many =
        key.kind == Kind::vector || key.kind == Kind::indices || key.kind == Kind::numbers || key.kind == Kind::box;
    text += (many ? ", each " : ", ") + range;
  }
  return text;
}

}  // namespace rhexis::scene
