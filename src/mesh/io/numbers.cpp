#include "mesh/io/numbers.h"

#include <type_traits>

namespace rhexis::mesh::io {
namespace {

template <class From, class To>
void append_as(std::string_view bytes, bool swap, std::vector<To>& out) {
  for (std::size_t at = 0; at + sizeof(From) <= bytes.size(); at += sizeof(From)) {
    out.push_back(static_cast<To>(load_binary<From>(bytes.data() + at, swap)));
  }
}

}  // namespace

std::size_t size_of(Scalar type) {
  switch (type) {
    case Scalar::int8:
    case Scalar::uint8: return 1;
    case Scalar::int16:
    case Scalar::uint16: return 2;
    case Scalar::int32:
    case Scalar::uint32:
    case Scalar::float32: return 4;
    case Scalar::int64:
    case Scalar::uint64:
    case Scalar::float64: break;
  }
  return 8;
}

template <class T>
int Numbers<T>::line_of(std::size_t index) const {
  if (text.empty()) return line;
  Cursor cursor(text, line);
  const std::size_t word = words.empty() ? index : words[index];
  for (std::size_t i = 0; i <= word && !cursor.at_end(); ++i) cursor.word("a value");
  return cursor.line();
}
template struct Numbers<double>;
template struct Numbers<std::int64_t>;

template <class T>
std::vector<T> decode(std::string_view bytes, Scalar type, bool swap) {
  std::vector<T> out;
  out.reserve(bytes.size() / size_of(type));
  switch (type) {
    case Scalar::int8: append_as<std::int8_t>(bytes, swap, out); break;
    case Scalar::uint8: append_as<std::uint8_t>(bytes, swap, out); break;
    case Scalar::int16: append_as<std::int16_t>(bytes, swap, out); break;
    case Scalar::uint16: append_as<std::uint16_t>(bytes, swap, out); break;
    case Scalar::int32: append_as<std::int32_t>(bytes, swap, out); break;
    case Scalar::uint32: append_as<std::uint32_t>(bytes, swap, out); break;
    case Scalar::int64: append_as<std::int64_t>(bytes, swap, out); break;
    case Scalar::uint64: append_as<std::uint64_t>(bytes, swap, out); break;
    case Scalar::float32: append_as<float>(bytes, swap, out); break;
    case Scalar::float64: append_as<double>(bytes, swap, out); break;
  }
  return out;
}
template std::vector<double> decode(std::string_view, Scalar, bool);
template std::vector<std::int64_t> decode(std::string_view, Scalar, bool);

template <class T>
Numbers<T> read_text(Cursor& cursor, std::optional<std::size_t> count, std::string_view name) {
  if (count) cursor.check_room(*count, 2, fmt::format("values of {}", name));
  cursor.at_end();  // so that the line is that of the first value
  Numbers<T> out{{}, cursor.rest(), cursor.line()};
  if (count) out.values.reserve(*count);
  const std::string wanted = fmt::format("a value of {}", name);
  while (count ? out.values.size() < *count : !cursor.at_end()) {
    if constexpr (std::is_floating_point_v<T>) {
      out.values.push_back(cursor.number(wanted));
    } else {
      out.values.push_back(cursor.integer<T>(wanted));
    }
  }
  return out;
}
template Reals read_text(Cursor&, std::optional<std::size_t>, std::string_view);
template Integers read_text(Cursor&, std::optional<std::size_t>, std::string_view);

}  // namespace rhexis::mesh::io
