#pragma once

/// An input of a target that reads a file of HDF5: the file itself, or what a good file holds, cut into lists, so that
/// mutations reach that and not only how the file is laid out.

#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <vector>

namespace rhexis::fuzz {

/// All of `input`, as far as it fills rows.
template <class Row>
void take_rest(std::span<const std::uint8_t> input, std::vector<Row>& rows) {
  rows.resize(input.size() / sizeof(Row));
  if (!rows.empty()) std::memcpy(rows.data(), input.data(), rows.size() * sizeof(Row));
}

/// Takes a list off the front of `input`, where it stands behind its size in bytes (16 bits, little-endian).
template <class Row>
void take_part(std::span<const std::uint8_t>& input, std::vector<Row>& rows) {
  if (input.size() < 2) return;
  const std::size_t size = std::min<std::size_t>(input[0] | (input[1] << 8), input.size() - 2);
  take_rest(input.subspan(2, size), rows);
  input = input.subspan(2 + size);
}

template <class Row>
void add_rest(const std::vector<Row>& rows, std::vector<std::uint8_t>& input) {
  const auto* begin = reinterpret_cast<const std::uint8_t*>(rows.data());
  input.insert(input.end(), begin, begin + rows.size() * sizeof(Row));
}

template <class Row>
void add_part(const std::vector<Row>& rows, std::vector<std::uint8_t>& input) {
  const std::size_t size = rows.size() * sizeof(Row);
  for (const std::size_t byte : {size & 255, size >> 8}) input.push_back(static_cast<std::uint8_t>(byte));
  add_rest(rows, input);
}

/// The last bit of the first byte chooses: the other bytes are a file, or write(path, first byte, other bytes) makes
/// one. read(path) reads it.
template <class Write, class Read>
void read_as_file(std::span<const std::uint8_t> input, const Write& write, const Read& read) {
  if (input.empty()) return;
  const std::span<const std::uint8_t> rest = input.subspan(1);
  const std::string path = std::filesystem::temp_directory_path() / ("rhexis_fuzz" + std::to_string(::getpid()));
  if ((input[0] & 1) != 0) {
    write(path, input[0], rest);
  } else {
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(rest.data()), static_cast<std::streamsize>(rest.size()));
  }
  read(path);
  std::filesystem::remove(path);  // not written over: HDF5 may keep open what it refuses
}

}  // namespace rhexis::fuzz
