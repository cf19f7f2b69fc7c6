#pragma once

/// Reads datasets and attributes of a foreign HDF5 file. HDF5 1.10 can crash on hostile files: what a mesh has no need
/// of (other types, filters, links and storage elsewhere) is refused before the library touches the data.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "mesh/io/hdf5_handle.h"
#include "mesh/io/numbers.h"

namespace rhexis::mesh::io {

class Hdf5Input {
 public:
  /// Throws ReadFailure when `image` is no HDF5 file.
  explicit Hdf5Input(std::string_view image);

  /// The group inside `parent`, refused when it is missing or a link out of the file.
  [[nodiscard]] Hdf5Handle group(hid_t parent, const char* name) const;
  [[nodiscard]] hid_t file() const { return file_; }
  [[nodiscard]] bool has(hid_t group, const char* name) const;
  /// Names of what lies in a group, in the order of creation where the file keeps that, else by name.
  [[nodiscard]] std::vector<std::string> names(hid_t group) const;

  /// A string; refused when there is none or it is longer than 256 bytes.
  [[nodiscard]] std::string text_attribute(hid_t group, const char* name) const;
  [[nodiscard]] std::vector<std::int64_t> integer_attribute(hid_t group, const char* name) const;

  /// An array of rank 1 or 2; `columns` is 1 for rank 1. Throws ReadFailure.
  template <class T>
  struct Table {
    Numbers<T> values;
    std::size_t columns = 1;
  };
  template <class T>
  [[nodiscard]] Table<T> dataset(hid_t group, const char* name);
  /// True for a dataset of numbers.
  [[nodiscard]] bool is_numeric(hid_t group, const char* name) const;

 private:
  Hdf5Quiet quiet_;
  Hdf5Handle file_;
  std::size_t budget_ = 0;  ///< bytes that arrays may still unpack to
};

}  // namespace rhexis::mesh::io
