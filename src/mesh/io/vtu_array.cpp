#include "mesh/io/vtu_array.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "mesh/io/base64.h"
#include "mesh/io/cursor.h"
#include "mesh/io/gzip.h"

namespace rhexis::mesh::io {
namespace {

/// Bytes of one array, whether they stand in the file as they are or as base64.
class ByteSource {
 public:
  ByteSource(std::string_view bytes, bool base64) : raw_(bytes), base64_(base64), decoder_(bytes) {}
  std::string read(std::size_t count) {
    if (base64_) return decoder_.read(count);
    if (count > raw_.size()) refuse("appended data end early", "the file may be cut short");
    std::string out(raw_.substr(0, count));
    raw_.remove_prefix(count);
    return out;
  }
  [[nodiscard]] std::size_t most_left() const { return base64_ ? decoder_.most_left() : raw_.size(); }

 private:
  std::string_view raw_;
  bool base64_;
  Base64Reader decoder_;
};

std::uint64_t read_length(const VtuEncoding& file, ByteSource& source) {
  const std::string bytes = source.read(file.wide_header ? 8 : 4);
  return file.wide_header ? load_binary<std::uint64_t>(bytes.data(), file.swap)
                          : load_binary<std::uint32_t>(bytes.data(), file.swap);
}

void spend(VtuEncoding& file, std::uint64_t bytes) {
  if (bytes > file.unpack_budget)
    refuse("its arrays unpack to far more than a file of its size should hold", "write it again without compression");
  file.unpack_budget -= bytes;
}

/// Compressed arrays start with the number of blocks, the size of a block and of the last, partial one (0: it is
/// whole) before compression, and the size of each block after compression.
std::string read_compressed(VtuEncoding& file, ByteSource& source) {
  const std::uint64_t blocks = read_length(file, source);
  const std::uint64_t block_size = read_length(file, source);
  const std::uint64_t last_size = read_length(file, source);
  if (blocks == 0) return {};
  if (blocks > source.most_left() / 4)
    refuse(fmt::format("{} compressed blocks are promised, more than the data can hold", blocks));
  if (block_size > file.unpack_budget || last_size > block_size) {
    refuse(fmt::format("compressed blocks of {} bytes, the last of {}, make no sense", block_size, last_size));
  }
  std::vector<std::uint64_t> packed(blocks);
  for (std::uint64_t& size : packed) size = read_length(file, source);
  std::string out;
  for (std::size_t i = 0; i < blocks; ++i) {
    if (packed[i] > source.most_left()) refuse("compressed data end early", "the file may be cut short");
    const std::uint64_t size = i + 1 == blocks && last_size > 0 ? last_size : block_size;
    spend(file, size);
    append_inflated(source.read(packed[i]), size, out);
  }
  return out;
}

std::string read_bytes(VtuEncoding& file, ByteSource source) {
  if (file.zlib) return read_compressed(file, source);
  const std::uint64_t size = read_length(file, source);
  if (size > source.most_left()) {
    refuse(fmt::format("{} bytes are promised, {} are there", size, source.most_left()), "the file may be cut short");
  }
  spend(file, size);
  return source.read(size);
}

std::string_view text_of(const VtuEncoding& file, pugi::xml_node array, int& line) {
  const pugi::xml_node text = array.first_child();
  if (text.type() != pugi::node_pcdata && text.type() != pugi::node_cdata) return {};
  const auto offset =
      std::clamp<std::ptrdiff_t>(text.offset_debug(), 0, static_cast<std::ptrdiff_t>(file.document.size()));
  line = 1 + static_cast<int>(std::count(file.document.begin(), file.document.begin() + offset, '\n'));
  return text.value();
}

template <class T>
Numbers<T> read_array(VtuEncoding& file, pugi::xml_node array) {
  const Scalar type = scalar_of(file, array);
  const std::string name = array.attribute("Name").as_string("Points");
  const std::string_view format = array.attribute("format").as_string("ascii");
  int line = line_of(file, array);
  try {
    if (format == "ascii") {
      const std::string_view text = text_of(file, array, line);
      Cursor cursor(text, line);
      return read_text<T>(cursor, std::nullopt, name);
    }
    std::string bytes;
    if (format == "binary") {
      bytes = read_bytes(file, ByteSource(text_of(file, array, line), true));
    } else if (format == "appended") {
      const std::uint64_t offset = array.attribute("offset").as_ullong();
      if (offset >= file.appended.size()) {
        refuse(fmt::format("offset {} lies outside of the {} bytes of appended data", offset, file.appended.size()),
               "the file may be cut short");
      }
      bytes = read_bytes(file, ByteSource(file.appended.substr(offset), file.appended_base64));
    } else {
      refuse("format " + in_quotes(format) + " is not known", "ascii, binary or appended");
    }
    if (bytes.size() % size_of(type) != 0) {
      refuse(fmt::format("{} bytes are no whole number of values of {} bytes", bytes.size(), size_of(type)));
    }
    return {decode<T>(bytes, type, file.swap), {}, line_of(file, array)};
  } catch (ReadFailure& failure) {
    // Binary data know no line; the element does.
    if (failure.error.line == 0) {
      failure.error.line = line_of(file, array);
      failure.error.what = "array " + in_quotes(name) + ": " + failure.error.what;
    }
    throw;
  }
}

}  // namespace

int line_of(const VtuEncoding& file, pugi::xml_node node) {
  const auto offset =
      std::clamp<std::ptrdiff_t>(node.offset_debug(), 0, static_cast<std::ptrdiff_t>(file.document.size()));
  return 1 + static_cast<int>(std::count(file.document.begin(), file.document.begin() + offset, '\n'));
}

Scalar scalar_of(const VtuEncoding& file, pugi::xml_node array) {
  static constexpr std::array<std::pair<std::string_view, Scalar>, 10> kTypes{{{"Int8", Scalar::int8},
                                                                               {"UInt8", Scalar::uint8},
                                                                               {"Int16", Scalar::int16},
                                                                               {"UInt16", Scalar::uint16},
                                                                               {"Int32", Scalar::int32},
                                                                               {"UInt32", Scalar::uint32},
                                                                               {"Int64", Scalar::int64},
                                                                               {"UInt64", Scalar::uint64},
                                                                               {"Float32", Scalar::float32},
                                                                               {"Float64", Scalar::float64}}};
  const std::string_view name = array.attribute("type").as_string();
  for (const auto& [known, scalar] : kTypes) {
    if (name == known) return scalar;
  }
  refuse(fmt::format("array {} has the type {}", in_quotes(array.attribute("Name").as_string()), in_quotes(name)),
         "Int8 to UInt64, Float32 or Float64", line_of(file, array));
}

Reals read_reals(VtuEncoding& file, pugi::xml_node array) { return read_array<double>(file, array); }

Integers read_integers(VtuEncoding& file, pugi::xml_node array) {
  if (is_float(scalar_of(file, array))) {
    refuse(fmt::format("array {} does not hold whole numbers", in_quotes(array.attribute("Name").as_string())),
           "Int32 or Int64", line_of(file, array));
  }
  return read_array<std::int64_t>(file, array);
}

}  // namespace rhexis::mesh::io
