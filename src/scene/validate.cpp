#include <algorithm>

#include "scene/value_of.h"
#include "scene/values.h"

namespace rhexis::scene {
namespace {

std::vector<std::string> names_of(const std::vector<Key>& keys) {
  std::vector<std::string> names;
  for (const Key& key : keys) names.push_back(key.name);
  return names;
}

/// Of the keys of which exactly one must be given.
Expected<void> check_exactly_one(const SectionValues& values) {
  const std::vector<std::string>& choices = values.section->exactly_one;
  if (choices.empty()) return {};
  std::vector<std::string> given;
  for (const std::string& key : choices)
    if (values.given_key(key)) given.push_back(key);
  std::string list;
  for (const std::string& key : choices)
    list += (list.empty() ? "" : &key == &choices.back() ? " or " : ", ") + in_quotes(key);
  if (given.empty())
    return values.place.fail(fmt::format("{} says nothing of {}", in_quotes(values.path), list), "give one of them");
  if (given.size() > 1) {
    // At the later of the two, which is the one that is too many.
    const Place first = values.place_of(given[0]);
    const Place second = values.place_of(given[1]);
    const bool ordered = second.line == 0 || (first.line != 0 && first.line <= second.line);
    return (ordered ? second : first)
        .fail(fmt::format("{} and {} are both given", in_quotes(values.path_of(given[0])),
                          in_quotes(values.path_of(given[1]))),
              "give one of them");
  }
  return {};
}

/// The defaults are part of the program: one that does not read is a mistake of ours.
Setting default_of(const Key& key) {
  const Expected<Node> parsed = parse_document("value = " + key.fallback, "the default");
  RHEXIS_CHECK(parsed, "default of '{}'", key.name);
  const Expected<Value> value = value_of(key, parsed->as<Table>()->front().node, key.name);
  RHEXIS_CHECK(value, "default of '{}': {}", key.name, value.error().message());
  return {*value, {}, false};
}

/// The keys of one section, their defaults, and what is missing.
Expected<void> read_keys(const Table& table, SectionValues& values) {
  for (const Entry& entry : table) {
    const std::string path = values.path_of(entry.key);
    const Key* key = values.section->find(entry.key);
    if (key == nullptr)
      return entry.node.place.fail("unknown key " + in_quotes(path),
                                   suggest(entry.key, names_of(values.section->keys)));
    Expected<Value> value = value_of(*key, entry.node, path);
    if (!value) return fail(std::move(value.error()));
    values.settings[key->name] = {std::move(*value), entry.node.place, true};
  }
  for (const Key& key : values.section->keys) {
    if (values.given_key(key.name)) continue;
    if (key.required && values.given)
      return values.place.fail(in_quotes(values.path_of(key.name)) + " is missing", "give " + wanted(key));
    if (!key.fallback.empty()) values.settings[key.name] = default_of(key);
  }
  return values.given ? check_exactly_one(values) : Expected<void>{};
}

class Validator {
 public:
  explicit Validator(std::span<const Section> sections) : sections_(sections) {}

  Expected<Values> run(const Node& root) {
    values_.file = root.place;
    for (const Section& section : sections_) values_.sections[section.name];
    Table root_keys;
    for (const Entry& entry : *root.as<Table>())
      if (sections_.front().find(entry.key) != nullptr) root_keys.push_back(entry);
    if (Expected<void> read = read_one("", "", root_keys, root.place, true); !read)
      return fail(std::move(read.error()));
    for (const Entry& entry : *root.as<Table>()) {
      if (sections_.front().find(entry.key) != nullptr) continue;
      if (Expected<void> read = read_section(entry); !read) return fail(std::move(read.error()));
    }
    for (const Section& section : sections_) {
      if (section.form != SectionForm::single || !values_.sections[section.name].empty()) continue;
      if (section.required) return root.place.fail(header_of(section) + " is missing", section_hint(section));
      if (Expected<void> read = read_one(section.name, section.name, {}, root.place, false); !read)
        return fail(std::move(read.error()));
    }
    return std::move(values_);
  }

 private:
  static std::string section_hint(const Section& section) {
    std::string keys;
    for (const Key& key : section.keys) keys += (keys.empty() ? "" : ", ") + key.name;
    return "a section with " + keys;
  }

  Expected<void> read_section(const Entry& entry) {
    const Section* section = entry.key.empty() ? nullptr : find(entry.key);
    if (section == nullptr) return unknown(entry);
    const Place& place = entry.node.place;
    const Table* table = entry.node.as<Table>();
    const Array* array = entry.node.as<Array>();
    const std::string& name = section->name;
    switch (section->form) {
      case SectionForm::root: break;
      case SectionForm::single:
        if (table == nullptr) return wrong_form(entry, *section);
        return read_one(name, name, *table, place, true);
      case SectionForm::named:
        if (table == nullptr) return wrong_form(entry, *section);
        for (const Entry& named : *table) {
          const Table* keys = named.node.as<Table>();
          if (named.key.empty()) return named.node.place.fail("a section of " + in_quotes(name) + " has an empty name");
          if (keys == nullptr)
            return named.node.place.fail(
                fmt::format("{} is {}", in_quotes(name + '.' + named.key), named.node.type_name()),
                "write " + header_of(*section) + " and its keys below");
          if (Expected<void> read = read_one(name, name + '.' + named.key, *keys, named.node.place, true, named.key);
              !read)
            return read;
        }
        return {};
      case SectionForm::list:
        if (array == nullptr) return wrong_form(entry, *section);
        for (std::size_t i = 0; i < array->size(); ++i) {
          const Table* keys = (*array)[i].as<Table>();
          if (keys == nullptr) return wrong_form(entry, *section);
          if (Expected<void> read = read_one(name, fmt::format("{}.{}", name, i), *keys, (*array)[i].place, true);
              !read)
            return read;
        }
        return {};
    }
    return {};
  }

  Expected<void> read_one(const std::string& section, std::string path, const Table& table, const Place& place,
                          bool given, std::string name = {}) {
    SectionValues values{.section = section.empty() ? &sections_.front() : find(section),
                         .name = std::move(name),
                         .path = std::move(path),
                         .place = place,
                         .given = given,
                         .settings = {}};
    if (Expected<void> read = read_keys(table, values); !read) return read;
    values_.sections[section].push_back(std::move(values));
    return {};
  }

  static tl::unexpected<Error> wrong_form(const Entry& entry, const Section& section) {
    return entry.node.place.fail(fmt::format("{} is {}", in_quotes(entry.key), entry.node.type_name()),
                                 "write " + header_of(section));
  }

  tl::unexpected<Error> unknown(const Entry& entry) const {
    std::vector<std::string> known;
    for (const Section& section : sections_)
      if (section.form != SectionForm::root) known.push_back(section.name);
    const bool is_section = entry.node.as<Table>() != nullptr || entry.node.as<Array>() != nullptr;
    if (!is_section) {
      const std::vector<std::string> keys = names_of(sections_.front().keys);
      known.insert(known.begin(), keys.begin(), keys.end());
    }
    return entry.node.place.fail((is_section ? "unknown section " : "unknown key ") + in_quotes(entry.key),
                                 suggest(entry.key, known));
  }

  [[nodiscard]] const Section* find(std::string_view name) const {
    const auto found =
        std::find_if(sections_.begin(), sections_.end(), [&](const Section& s) { return s.name == name; });
    return found == sections_.end() ? nullptr : &*found;
  }

  std::span<const Section> sections_;
  Values values_;
};

}  // namespace

Expected<Values> validate(const Node& root, std::span<const Section> sections) { return Validator(sections).run(root); }

}  // namespace rhexis::scene
