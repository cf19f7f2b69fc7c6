#pragma once

/// Arrays of numbers as VTK's formats hold them: in any of ten types, as text or as bytes of either order.

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "mesh/io/cursor.h"

namespace rhexis::mesh::io {

enum class Scalar { int8, uint8, int16, uint16, int32, uint32, int64, uint64, float32, float64 };
[[nodiscard]] std::size_t size_of(Scalar type);
[[nodiscard]] inline bool is_float(Scalar type) { return type == Scalar::float32 || type == Scalar::float64; }

/// An array with the memory of where it came from, so that a value found wrong later can still be named by its line.
template <class T>
struct Numbers {
  std::vector<T> values;
  std::string_view text =
      {};        ///< what the values were read from, when that was text; lives as long as the file's bytes
  int line = 0;  ///< line of the first value when that was text, else of what describes the array; or 0
  std::vector<std::size_t> words = {};  ///< place of each value among the words of `text`; empty: its index

  /// Line of values[index], as far as it is known.
  [[nodiscard]] int line_of(std::size_t index) const;
};

using Reals = Numbers<double>;
using Integers = Numbers<std::int64_t>;

/// Decodes whole values; `bytes` is a multiple of the type's size. Unsigned 64-bit values beyond 2^63 come out
/// negative.
template <class T>
[[nodiscard]] std::vector<T> decode(std::string_view bytes, Scalar type, bool swap);

/// Reads `count` values of text, or all of it when there is no count. Throws ReadFailure. `name` for the message.
template <class T>
[[nodiscard]] Numbers<T> read_text(Cursor& cursor, std::optional<std::size_t> count, std::string_view name);

}  // namespace rhexis::mesh::io
