#pragma once

/// A TOML document as a tree in which everything knows where it was written: in a line of the scene, or in a `--set`.

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "base/error.h"

namespace rhexis::scene {

/// Where something was written.
struct Place {
  std::shared_ptr<const std::string> file;  ///< the scene's name, or `--set key=value`; null: nowhere, a default
  int line = 0;                             ///< 1-based; 0: not in a line

  [[nodiscard]] tl::unexpected<Error> fail(std::string what, std::string remedy = {}) const;
  /// "line 24", or "--set key=value"; for the second place of an error.
  [[nodiscard]] std::string describe() const;
};

struct Node;
struct Entry;
using Array = std::vector<Node>;
using Table = std::vector<Entry>;  ///< in the order of the document; keys are unique
struct DateOrTime {};              ///< which no key of a scene wants

struct Node {
  std::variant<bool, std::int64_t, double, std::string, Array, Table, DateOrTime> value;
  Place place;
  std::string raw;  ///< the characters of an override's value; empty for what the file says

  template <class T>
  [[nodiscard]] const T* as() const {
    return std::get_if<T>(&value);
  }
  template <class T>
  [[nodiscard]] T* as() {
    return std::get_if<T>(&value);
  }
  /// "text", "an array", ...
  [[nodiscard]] std::string_view type_name() const;
};

struct Entry {
  std::string key;
  Node node;
};

[[nodiscard]] const Entry* find_entry(const Table& table, std::string_view key);
[[nodiscard]] Entry* find_entry(Table& table, std::string_view key);

/// The largest scene that is read, bytes; room for a list of some hundred thousand nodes.
inline constexpr std::size_t kMaxSceneBytes = 4U << 20U;

/// How `what` ends in the error of parse_document about a number that 64 bits do not hold.
inline constexpr std::string_view kNumberTooLarge = "a number too large";

/// The root is a Table. Errors carry `name` and the line.
[[nodiscard]] Expected<Node> parse_document(std::string_view text, const std::string& name);

/// Text of the user as an error message shows it: control characters replaced, cut after `most` bytes.
[[nodiscard]] std::string one_line(std::string_view text, std::size_t most);
/// The same in single quotes, at most 60 bytes.
[[nodiscard]] std::string in_quotes(std::string_view text);

}  // namespace rhexis::scene
