#pragma once

/// Walks through the bytes of a file: words and numbers of its text, counting lines, and blocks of binary between them.

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>

#include <fmt/format.h>

#include "mesh/io/read_failure.h"

namespace rhexis::mesh::io {

/// The value of type T at `bytes`, which hold it in the other byte order when `swap`.
template <class T>
[[nodiscard]] T load_binary(const char* bytes, bool swap) {
  std::array<char, sizeof(T)> copy;
  std::memcpy(copy.data(), bytes, sizeof(T));
  if (swap) std::reverse(copy.begin(), copy.end());
  T value;
  std::memcpy(&value, copy.data(), sizeof(T));
  return value;
}

/// Every function that reads throws ReadFailure with the line when the bytes are not what is wanted; `wanted` names
/// that for the message.
class Cursor {
 public:
  explicit Cursor(std::string_view bytes, int first_line = 1) : bytes_(bytes), line_(first_line) {}

  /// Line of the last word read; 0 once binary has been passed, after which lines mean nothing.
  [[nodiscard]] int line() const { return binary_passed_ ? 0 : line_; }
  [[nodiscard]] std::size_t left() const { return bytes_.size() - position_; }

  /// Skips blanks and line ends; true when nothing follows.
  bool at_end();
  /// The next word (blanks and line ends separate words).
  std::string_view word(std::string_view wanted);
  /// The next word, left where it is; empty at the end.
  [[nodiscard]] std::string_view peek() const;
  /// Whether that word stands on the line of the last one.
  [[nodiscard]] bool more_on_line() const;
  /// All that has not been read.
  [[nodiscard]] std::string_view rest() const { return bytes_.substr(position_); }
  /// The rest of the line without its end, and past it.
  std::string_view rest_of_line();

  template <class T = std::int64_t>
  T integer(std::string_view wanted) {
    const std::string_view text = word(wanted);
    T value{};
    const char* first = text.data() + (text.size() > 1 && text.front() == '+' ? 1 : 0);
    const auto [end, code] = std::from_chars(first, text.data() + text.size(), value);
    if (code == std::errc::result_out_of_range) refuse(fmt::format("{} {} is out of range", wanted, in_quotes(text)));
    if (code != std::errc{} || end != text.data() + text.size()) {
      refuse(fmt::format("{} should be a whole number, not {}", wanted, in_quotes(text)));
    }
    return value;
  }
  /// Any number, infinities and NaN included.
  double number(std::string_view wanted);

  /// Words until end_record() have to stand on one line: a line that is too short or too long is named itself, not the
  /// one after it. Gmsh's `$` closes a section, so it cannot begin a record.
  void begin_record(std::string_view what);
  void end_record(std::string_view what);

  /// The next `count` bytes as they are.
  std::string_view binary(std::size_t count, std::string_view wanted);
  template <class T>
  T binary_value(bool swap, std::string_view wanted) {
    return load_binary<T>(binary(sizeof(T), wanted).data(), swap);
  }
  /// Moves behind the next occurrence of `text`; false, and nowhere, when there is none.
  bool skip_past(std::string_view text);

  /// Refuses a count of things that need at least `least_bytes` each when the rest of the file cannot hold them:
  /// called before anything is allocated for them.
  void check_room(std::uint64_t count, std::size_t least_bytes, std::string_view things) const;

  /// Throws ReadFailure on this line.
  [[noreturn]] void refuse(std::string what, std::string remedy = {}) const {
    io::refuse(std::move(what), std::move(remedy), line());
  }

 private:
  void skip_blanks(bool over_lines);

  std::string_view bytes_;
  std::size_t position_ = 0;
  int line_ = 1;
  bool binary_passed_ = false;
  bool in_record_ = false;
};

}  // namespace rhexis::mesh::io
