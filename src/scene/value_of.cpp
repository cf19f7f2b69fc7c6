#include "scene/value_of.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "base/nearest_name.h"

namespace rhexis::scene {
namespace {

std::optional<double> number_in(const Node& node) {
  if (const auto* number = node.as<double>()) return *number;
  if (const auto* integer = node.as<std::int64_t>()) return static_cast<double>(*integer);
  return std::nullopt;
}

/// "50%", "-30 %".
std::optional<double> percentage_in(std::string_view text) {
  const auto trim = [&] {
    while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
    while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  };
  trim();
  if (text.empty() || text.back() != '%') return std::nullopt;
  text.remove_suffix(1);
  trim();
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  double value = 0.0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

/// What stands where something else is wanted. The value of an override that is no TOML counts as text, and a number
/// beyond 64 bits is none.
std::string what_is(const Node& node) {
  if (node.as<std::string>() != nullptr && !node.raw.empty()) {
    const Expected<Node> parsed = parse_document("value = " + node.raw, {});
    if (!parsed && parsed.error().what.ends_with(kNumberTooLarge))
      return fmt::format("{}, {}", one_line(node.raw, 60), kNumberTooLarge);
  }
  return std::string(node.type_name());
}

/// One key, its node and its path: the checks of each form.
class Reader {
 public:
  Reader(const Key& key, const Node& node, const std::string& path) : key_(key), node_(node), path_(path) {}

  Expected<Value> read() const {
    switch (key_.kind) {
      case Kind::boolean: return node_.as<bool>() != nullptr ? Expected<Value>(*node_.as<bool>()) : wrong_type();
      case Kind::integer: return integer(node_, path_).map([](std::int64_t value) { return Value(value); });
      case Kind::number: return number(node_, path_).map([](double value) { return Value(value); });
      case Kind::text:
      case Kind::file:
      case Kind::set: return text();
      case Kind::choice: return choice();
      case Kind::vector: return vector(node_, path_).map([](const Vec3& value) { return Value(value); });
      case Kind::indices: return list<std::int64_t>(&Reader::integer);
      case Kind::numbers: return list<double>(&Reader::number);
      case Kind::number_or_auto: return number_or_auto();
      case Kind::length: return length();
      case Kind::box: return box();
    }
    return wrong_type();
  }

 private:
  tl::unexpected<Error> wrong(const Node& node, const std::string& path, const std::string& is) const {
    return node.place.fail(fmt::format("{} is {}", in_quotes(path), is), "give " + wanted(key_));
  }
  /// Text beside which a number may stand: the text itself says more than that it is some.
  std::string text_is(const std::string& text) const {
    const std::string is = what_is(node_);
    return is == node_.type_name() ? in_quotes(text) : is;
  }
  tl::unexpected<Error> wrong_type() const { return wrong(node_, path_, what_is(node_)); }

  Expected<double> number(const Node& node, const std::string& path) const {
    const std::optional<double> value = number_in(node);
    if (!value) return wrong(node, path, what_is(node));
    if (!key_.range.holds(*value)) return wrong(node, path, fmt::format("{}", *value));
    return *value;
  }

  Expected<std::int64_t> integer(const Node& node, const std::string& path) const {
    const auto* value = node.as<std::int64_t>();
    if (value == nullptr) return wrong(node, path, what_is(node));
    if (!key_.range.holds(static_cast<double>(*value))) return wrong(node, path, fmt::format("{}", *value));
    return *value;
  }

  /// Text of a `--set` needs no quotes, so what looks like a number there is text where text is wanted.
  const std::string* text_in_node() const {
    if (const auto* text = node_.as<std::string>()) return text;
    return node_.raw.empty() ? nullptr : &node_.raw;
  }

  Expected<Value> text() const {
    const std::string* value = text_in_node();
    if (value == nullptr) return wrong_type();
    const bool printable = std::none_of(value->begin(), value->end(),
                                        [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; });
    if (!printable)
      return node_.place.fail(in_quotes(path_) + " holds a control character", "printable text in one line");
    if (value->empty() && key_.kind != Kind::text)
      return node_.place.fail(in_quotes(path_) + " is empty", "give " + wanted(key_));
    return Value(*value);
  }

  Expected<Value> choice() const {
    const std::string* value = text_in_node();
    if (value == nullptr) return wrong_type();
    if (std::find(key_.names.begin(), key_.names.end(), *value) == key_.names.end())
      return node_.place.fail(fmt::format("{} is {}, an unknown name", in_quotes(path_), in_quotes(*value)),
                              suggest(*value, key_.names));
    return Value(*value);
  }

  Expected<Vec3> vector(const Node& node, const std::string& path) const {
    const Array* items = node.as<Array>();
    if (items == nullptr) return wrong(node, path, what_is(node));
    if (items->size() != 3) return wrong(node, path, fmt::format("a list of {}", items->size()));
    Vec3 value;
    for (int i = 0; i < 3; ++i) {
      const Expected<double> entry = number((*items)[static_cast<std::size_t>(i)], fmt::format("{}.{}", path, i));
      if (!entry) return fail(entry.error());
      value[i] = *entry;
    }
    return value;
  }

  template <class Entry>
  Expected<Value> list(Expected<Entry> (Reader::*read_entry)(const Node&, const std::string&) const) const {
    const Array* items = node_.as<Array>();
    if (items == nullptr) return wrong_type();
    std::vector<Entry> value;
    for (std::size_t i = 0; i < items->size(); ++i) {
      const Expected<Entry> entry = (this->*read_entry)((*items)[i], fmt::format("{}.{}", path_, i));
      if (!entry) return fail(entry.error());
      value.push_back(*entry);
    }
    return Value(std::move(value));
  }

  Expected<Value> number_or_auto() const {
    if (const auto* text = node_.as<std::string>())
      return *text == "auto" ? Expected<Value>(Value(*text)) : wrong(node_, path_, text_is(*text));
    return number(node_, path_).map([](double value) { return Value(value); });
  }

  Expected<Value> length() const {
    if (const auto* text = node_.as<std::string>()) {
      const std::optional<double> percentage = percentage_in(*text);
      if (!percentage || !key_.range.holds(*percentage)) return wrong(node_, path_, text_is(*text));
      return Value(Length{*percentage / 100.0, true});
    }
    return number(node_, path_).map([](double value) { return Value(Length{value, false}); });
  }

  Expected<Value> box() const {
    const Table* table = node_.as<Table>();
    if (table == nullptr) return wrong_type();
    Box value;
    for (const Entry& entry : *table) {
      const std::string path = path_ + '.' + entry.key;
      if (entry.key != "from" && entry.key != "to")
        return entry.node.place.fail("unknown key " + in_quotes(path), suggest(entry.key, {"from", "to"}));
      const Expected<Vec3> corner = vector(entry.node, path);
      if (!corner) return fail(corner.error());
      (entry.key == "from" ? value.from : value.to) = *corner;
    }
    for (const std::string_view needed : {"from", "to"})
      if (find_entry(*table, needed) == nullptr)
        return node_.place.fail(in_quotes(path_ + '.' + std::string(needed)) + " is missing", "give " + wanted(key_));
    if ((value.from.array() > value.to.array()).any())
      return node_.place.fail(fmt::format("{} ends before it begins", in_quotes(path_)),
                              "'from' at most 'to' in x, y and z");
    return Value(value);
  }

  const Key& key_;
  const Node& node_;
  const std::string& path_;
};

}  // namespace

Expected<Value> value_of(const Key& key, const Node& node, const std::string& path) {
  return Reader(key, node, path).read();
}

std::string suggest(std::string_view name, const std::vector<std::string>& known) {
  // In one or two letters a slip cannot be told from another name, and nothing very long is a slip of the hand (the
  // search is quadratic in the length).
  constexpr std::size_t kShortest = 3;
  constexpr std::size_t kLongest = 100;
  const bool comparable = name.size() >= kShortest && name.size() <= kLongest;
  const std::string near = comparable ? nearest_name(name, known) : std::string{};
  if (!near.empty()) return "did you mean " + in_quotes(near) + "?";
  constexpr std::size_t kMostListed = 20;
  std::string list;
  for (std::size_t i = 0; i < std::min(known.size(), kMostListed); ++i)
    list += (i == 0 ? "" : ", ") + one_line(known[i], 60);
  if (known.size() > kMostListed) list += ", ...";
  return list.empty() ? "there are none" : "known: " + list;
}

}  // namespace rhexis::scene
