#pragma once

/// Single values in HDF5 files of our own formats: the types as they are stored, attributes, and the signature that a
/// foreign file is asked for before the library sees it.

#include <cstdint>
#include <filesystem>
#include <string>
#include <type_traits>

#include <hdf5.h>

#include "mesh/io/hdf5_handle.h"

namespace rhexis::mesh::io {

/// Little-endian, which is also how it lies in memory on the machines that are supported.
template <class Value>
[[nodiscard]] hid_t stored_type() {
  if constexpr (std::is_same_v<Value, double>) return H5T_IEEE_F64LE;
  if constexpr (std::is_same_v<Value, float>) return H5T_IEEE_F32LE;
  if constexpr (std::is_same_v<Value, std::int64_t>) return H5T_STD_I64LE;
  if constexpr (std::is_same_v<Value, std::int32_t>) return H5T_STD_I32LE;
  if constexpr (std::is_same_v<Value, std::uint64_t>) return H5T_STD_U64LE;
  if constexpr (std::is_same_v<Value, std::uint8_t>) return H5T_STD_U8LE;
}

/// It begins as an HDF5 file does.
[[nodiscard]] bool has_hdf5_signature(const std::filesystem::path& path);

/// A string of fixed size, of at most 64 KiB; empty: there is none of that form.
[[nodiscard]] std::string text_attribute(hid_t in, const char* name);
[[nodiscard]] bool set_text_attribute(hid_t in, const char* name, const std::string& text);

/// False, and `value` stays: there is none of that form.
template <class Value>
[[nodiscard]] bool number_attribute(hid_t in, const char* name, Value& value) {
  if (H5Aexists(in, name) <= 0) return false;
  const Hdf5Handle attribute(H5Aopen(in, name, H5P_DEFAULT), H5Aclose);
  const Hdf5Handle type(attribute.valid() ? H5Aget_type(attribute) : -1, H5Tclose);
  const Hdf5Handle space(attribute.valid() ? H5Aget_space(attribute) : -1, H5Sclose);
  return type.valid() && H5Tequal(type, stored_type<Value>()) > 0 && space.valid() &&
         H5Sget_simple_extent_type(space) == H5S_SCALAR && H5Aread(attribute, stored_type<Value>(), &value) >= 0;
}
template <class Value>
[[nodiscard]] bool set_number_attribute(hid_t in, const char* name, Value value) {
  const Hdf5Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Hdf5Handle attribute(H5Acreate2(in, name, stored_type<Value>(), space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  return attribute.valid() && H5Awrite(attribute, stored_type<Value>(), &value) >= 0;
}

}  // namespace rhexis::mesh::io
