#include "scene/document.h"

#include <algorithm>
#include <tuple>
#include <utility>

// toml++ 3.3 fails assertions of its own on some broken documents ("[}]", "[[["). There the parser is not to go on in
// any build, nor the program to end: the assertion throws, and parse_document makes an error of it.
namespace rhexis::scene {
struct ParserGaveUp {};
constexpr void give_up_unless(bool condition) {
  if (!condition) throw ParserGaveUp{};
}
}  // namespace rhexis::scene
#undef NDEBUG
#define TOML_ASSERT(condition) ::rhexis::scene::give_up_unless(static_cast<bool>(condition))
#define TOML_EXCEPTIONS 1
#define TOML_ENABLE_FORMATTERS 0
#include <toml++/toml.h>

namespace rhexis::scene {
namespace {

/// Dotted keys nest one table a dot, and tables are destroyed recursively: this bounds the stack that a document can
/// ask for. A scene has one or two dots in a key.
constexpr int kMaxKeyDots = 2000;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Dots that may separate keys: not the decimal point of a number, not in a line that is a comment. Two dots around one
/// number (1.2.3) are no decimal points, so at most every other dot of a key goes uncounted.
int count_key_dots(std::string_view text) {
  int dots = 0;
  bool in_comment_line = false;
  bool only_blanks_yet = true;
  bool number_had_dot = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '\n') {
      in_comment_line = false;
      only_blanks_yet = true;
    } else if (only_blanks_yet && c == '#') {
      in_comment_line = true;
    }
    if (c != ' ' && c != '\t' && c != '\n') only_blanks_yet = false;
    if (c == '.' && !in_comment_line) {
      const bool between_digits = i > 0 && i + 1 < text.size() && is_digit(text[i - 1]) && is_digit(text[i + 1]);
      if (!between_digits || number_had_dot) ++dots;
      number_had_dot = between_digits;
    } else if (!is_digit(c)) {
      number_had_dot = false;
    }
  }
  return dots;
}

Place place_of(const toml::source_region& region, const std::shared_ptr<const std::string>& file) {
  return {file, static_cast<int>(region.begin.line)};
}

Node convert(const toml::node& from, const std::shared_ptr<const std::string>& file);

Table convert_table(const toml::table& from, const std::shared_ptr<const std::string>& file) {
  struct Item {
    toml::source_position begin;
    const toml::key* key;
    const toml::node* node;
  };
  std::vector<Item> items;
  for (const auto& [key, node] : from) items.push_back({key.source().begin, &key, &node});
  // toml++ sorts by key; a reader meets mistakes in the order of the document.
  std::stable_sort(items.begin(), items.end(), [](const Item& a, const Item& b) {
    return std::tie(a.begin.line, a.begin.column) < std::tie(b.begin.line, b.begin.column);
  });
  Table table;
  for (const Item& item : items) {
    table.push_back({std::string(item.key->str()), convert(*item.node, file)});
    if (item.begin.line > 0) table.back().node.place.line = static_cast<int>(item.begin.line);
  }
  return table;
}

Node convert(const toml::node& from, const std::shared_ptr<const std::string>& file) {
  Node node{.value = DateOrTime{}, .place = place_of(from.source(), file), .raw = {}};
  if (const toml::table* table = from.as_table()) {
    node.value = convert_table(*table, file);
  } else if (const toml::array* array = from.as_array()) {
    Array items;
    for (const toml::node& item : *array) items.push_back(convert(item, file));
    node.value = std::move(items);
  } else if (const auto* text = from.as_string()) {
    node.value = text->get();
  } else if (const auto* integer = from.as_integer()) {
    node.value = integer->get();
  } else if (const auto* number = from.as_floating_point()) {
    node.value = number->get();
  } else if (const auto* boolean = from.as_boolean()) {
    node.value = boolean->get();
  }
  return node;
}

bool gives_up(std::string_view text) {
  try {
    static_cast<void>(toml::parse(text));
  } catch (const toml::parse_error&) {
  } catch (const ParserGaveUp&) {
    return true;
  }
  return false;
}

/// The first line at whose end the parser has given up. It reads from front to back, so halving finds it.
int line_of_giving_up(std::string_view text) {
  std::vector<std::size_t> line_ends;
  for (std::size_t i = 0; i < text.size(); ++i)
    if (text[i] == '\n') line_ends.push_back(i + 1);
  const auto found = std::partition_point(line_ends.begin(), line_ends.end(),
                                          [&](std::size_t end) { return !gives_up(text.substr(0, end)); });
  return static_cast<int>(found - line_ends.begin()) + 1;
}

}  // namespace

tl::unexpected<Error> Place::fail(std::string what, std::string remedy) const {
  return rhexis::fail(std::move(what), std::move(remedy), file ? *file : std::string{}, line);
}

std::string Place::describe() const { return line > 0 ? "line " + std::to_string(line) : file ? *file : "the default"; }

std::string_view Node::type_name() const {
  switch (value.index()) {
    case 0: return "a boolean";
    case 1: return "an integer";
    case 2: return "a number";
    case 3: return "text";
    case 4: return "a list";
    case 5: return "a table";
    default: return "a date or time";
  }
}

const Entry* find_entry(const Table& table, std::string_view key) {
  const auto found = std::find_if(table.begin(), table.end(), [&](const Entry& entry) { return entry.key == key; });
  return found == table.end() ? nullptr : &*found;
}

Entry* find_entry(Table& table, std::string_view key) {
  return const_cast<Entry*>(find_entry(std::as_const(table), key));
}

Expected<Node> parse_document(std::string_view text, const std::string& name) {
  if (text.size() > kMaxSceneBytes)
    return fail(fmt::format("the scene has {} bytes", text.size()), fmt::format("at most {}", kMaxSceneBytes), name);
  if (count_key_dots(text) > kMaxKeyDots)
    return fail("the scene nests too deep", fmt::format("at most {} dots in its keys", kMaxKeyDots), name);
  try {
    const auto file = std::make_shared<const std::string>(name);
    return Node{.value = convert_table(toml::parse(text), file), .place = {file, 0}, .raw = {}};
  } catch (const toml::parse_error& error) {
    std::string_view what = error.description();
    for (const std::string_view prefix : {"Error while parsing ", "Error: "})
      if (what.substr(0, prefix.size()) == prefix) what.remove_prefix(prefix.size());
    return fail("not valid TOML: " + one_line(what, 300), {}, name, static_cast<int>(error.source().begin.line));
  } catch (const ParserGaveUp&) {
    return fail("not valid TOML", {}, name, line_of_giving_up(text));
  }
}

std::string one_line(std::string_view text, std::size_t most) {
  std::string out;
  for (const char c : text.substr(0, most)) out += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? '?' : c;
  if (text.size() > most) {
    // Not through the middle of a character of several bytes.
    while (!out.empty() && (static_cast<unsigned char>(out.back()) & 0xC0U) == 0x80U) out.pop_back();
    if (!out.empty() && static_cast<unsigned char>(out.back()) >= 0xC0U) out.pop_back();
    out += "...";
  }
  return out;
}

std::string in_quotes(std::string_view text) { return '\'' + one_line(text, 60) + '\''; }

}  // namespace rhexis::scene
