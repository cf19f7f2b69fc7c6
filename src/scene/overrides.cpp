#include "scene/overrides.h"

#include <charconv>
#include <optional>

#include "scene/declaration.h"
#include "scene/value_of.h"

namespace rhexis::scene {
namespace {

/// The parts of a dotted key, by the rules of TOML (parts in quotes may hold dots); empty when it is none.
std::vector<std::string> split_key(const std::string& key) {
  Expected<Node> parsed = parse_document(key + " = 0", {});
  std::vector<std::string> parts;
  const Node* node = parsed ? &*parsed : nullptr;
  while (node != nullptr) {
    const Table* table = node->as<Table>();
    if (table == nullptr) return parts;
    if (table->size() != 1) return {};
    parts.push_back(table->front().key);
    node = &table->front().node;
  }
  return {};
}

Node parse_value(const std::string& text) {
  if (Expected<Node> parsed = parse_document("value = " + text, {})) {
    if (Table& table = *parsed->as<Table>(); table.size() == 1) return std::move(table.front().node);
  }
  return Node{.value = text, .place = {}, .raw = {}};
}

void set_place(Node& node, const Place& place) {
  node.place = place;
  if (Array* array = node.as<Array>())
    for (Node& item : *array) set_place(item, place);
  if (Table* table = node.as<Table>())
    for (Entry& entry : *table) set_place(entry.node, place);
}

std::optional<std::size_t> index_of(const std::string& part) {
  std::size_t index = 0;
  const auto [end, code] = std::from_chars(part.data(), part.data() + part.size(), index);
  if (code != std::errc{} || end != part.data() + part.size()) return std::nullopt;
  return index;
}

/// Of what is to be taken out and is not there: that is as it should be, unless no scene could have it.
Expected<void> check_known(const std::vector<std::string>& parts, const Place& place) {
  const Section* section = find_section(parts.front());
  const bool is_root = section == nullptr || section->form == SectionForm::root;
  if (is_root) section = &scene_sections().front();
  const std::size_t at = is_root ? 0 : section->form == SectionForm::single ? 1 : 2;  // the part that names a key
  if (at >= parts.size() || section->find(parts[at]) != nullptr) return {};
  std::vector<std::string> known;
  for (const Key& key : section->keys) known.push_back(key.name);
  for (const Section& other : scene_sections())
    if (is_root && other.form != SectionForm::root) known.push_back(other.name);
  const auto end = parts.begin() + static_cast<std::ptrdiff_t>(at) + 1;
  return place.fail("unknown key " + in_quotes(fmt::format("{}", fmt::join(parts.begin(), end, "."))),
                    suggest(parts[at], known));
}

/// Takes the last part of the key out of what holds it. False: it is not there.
bool erase(Node& holder, const std::string& part) {
  if (Table* table = holder.as<Table>())
    return std::erase_if(*table, [&](const Entry& entry) { return entry.key == part; }) > 0;
  Array* array = holder.as<Array>();
  const auto index = index_of(part);
  if (array == nullptr || !index || *index >= array->size()) return false;
  array->erase(array->begin() + static_cast<std::ptrdiff_t>(*index));
  return true;
}

/// What a key that is not there yet starts as: the list of [[support]] and its like, else a table.
Node made_for(const std::string& part, const std::string& holder_path, const Place& place) {
  const Section* section = holder_path.empty() ? find_section(part) : nullptr;
  if (section != nullptr && section->form == SectionForm::list) return {.value = Array{}, .place = place, .raw = {}};
  return {.value = Table{}, .place = place, .raw = {}};
}

/// The child of that name, made when a table has none.
Expected<Node*> child(Node& holder, const std::string& part, const std::string& holder_path, const Place& place) {
  if (Table* table = holder.as<Table>()) {
    if (Entry* entry = find_entry(*table, part)) return &entry->node;
    table->push_back({part, made_for(part, holder_path, place)});
    return &table->back().node;
  }
  if (Array* array = holder.as<Array>()) {
    const auto index = index_of(part);
    if (index && *index < array->size()) return &(*array)[*index];
    const std::string remedy =
        array->empty() ? "it is empty" : fmt::format("{}.0 to {}.{}", holder_path, holder_path, array->size() - 1);
    return place.fail(in_quotes(holder_path) + " has no entry " + in_quotes(part), remedy);
  }
  return place.fail(
      fmt::format("{} is {}, it holds no {}", in_quotes(holder_path), holder.type_name(), in_quotes(part)));
}

}  // namespace

Expected<void> apply_override(Node& root, const std::string& override) {
  const Place place{std::make_shared<const std::string>("--set " + one_line(override, 200)), 0};
  // As a comment anything goes that is one line of valid text.
  if (override.find('\n') != std::string::npos || !parse_document("# " + override, {}))
    return place.fail("not a line of text in UTF-8", "--set key=value, as in --set model.beta=0");
  const std::size_t equals = override.find('=');
  if (equals == std::string::npos) return place.fail("no '=' in it", "--set key=value, as in --set model.beta=0");
  const std::vector<std::string> parts = split_key(override.substr(0, equals));
  if (parts.empty()) return place.fail("not a key before the '='", "a dotted name, as in --set model.beta=0");
  const std::string text = override.substr(equals + 1);

  Node* holder = &root;
  std::string path;
  for (std::size_t i = 0; i + 1 < parts.size(); ++i) {
    const Table* table = holder->as<Table>();
    if (text.empty() && table != nullptr && find_entry(*table, parts[i]) == nullptr) return check_known(parts, place);
    Expected<Node*> next = child(*holder, parts[i], path, place);
    if (!next) return fail(std::move(next.error()));
    holder = *next;
    path += (i == 0 ? "" : ".") + parts[i];
  }
  if (text.empty()) return erase(*holder, parts.back()) ? Expected<void>{} : check_known(parts, place);
  Expected<Node*> target = child(*holder, parts.back(), path, place);
  if (!target) return fail(std::move(target.error()));
  **target = parse_value(text);
  (*target)->raw = text;
  set_place(**target, place);
  return {};
}

}  // namespace rhexis::scene
