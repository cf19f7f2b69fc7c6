#include "mesh/io/hdf5_input.h"

#include <algorithm>
#include <array>
#include <type_traits>

#include <fmt/format.h>

#include "mesh/io/gzip.h"
#include "mesh/io/hdf5_checks.h"
#include "mesh/io/read_failure.h"

namespace rhexis::mesh::io {
namespace {

constexpr std::size_t kLongestText = 256;

/// The plain types of numbers; anything else (bit fields, odd precisions, compounds) is left to other programs.
bool is_plain_number(hid_t type, bool integers_only) {
  const std::array<hid_t, 16> integers{H5T_STD_I8LE,  H5T_STD_U8LE,  H5T_STD_I16LE, H5T_STD_U16LE,
                                       H5T_STD_I32LE, H5T_STD_U32LE, H5T_STD_I64LE, H5T_STD_U64LE,
                                       H5T_STD_I8BE,  H5T_STD_U8BE,  H5T_STD_I16BE, H5T_STD_U16BE,
                                       H5T_STD_I32BE, H5T_STD_U32BE, H5T_STD_I64BE, H5T_STD_U64BE};
  const std::array<hid_t, 4> floats{H5T_IEEE_F32LE, H5T_IEEE_F64LE, H5T_IEEE_F32BE, H5T_IEEE_F64BE};
  const auto same = [&](hid_t known) { return H5Tequal(type, known) > 0; };
  return std::any_of(integers.begin(), integers.end(), same) ||
         (!integers_only && std::any_of(floats.begin(), floats.end(), same));
}

}  // namespace

Hdf5Input::Hdf5Input(std::string_view image) : budget_(std::max(unpacked_limit(image.size()), image.size())) {
  constexpr std::string_view kSignature = "\x89HDF\r\n\x1a\n";
  if (!image.starts_with(kSignature)) refuse("it is not an HDF5 file");
  file_ = open_in_memory(image);
  if (!file_.valid()) refuse("HDF5 cannot open it", "it may be cut short or damaged");
}

bool Hdf5Input::has(hid_t group, const char* name) const { return H5Lexists(group, name, H5P_DEFAULT) > 0; }

Hdf5Handle Hdf5Input::group(hid_t parent, const char* name) const {
  if (!has(parent, name))
    refuse(fmt::format("it holds no group {}", in_quotes(name)), "a VTKHDF file keeps its mesh there");
  if (!is_object(parent, name, H5O_TYPE_GROUP)) refuse(fmt::format("{} is not a group of this file", in_quotes(name)));
  Hdf5Handle opened(H5Gopen2(parent, name, H5P_DEFAULT), H5Gclose);
  if (!opened.valid()) refuse(fmt::format("group {} cannot be opened", in_quotes(name)), "the file may be damaged");
  return opened;
}

std::vector<std::string> Hdf5Input::names(hid_t group) const {
  H5G_info_t info;
  if (H5Gget_info(group, &info) < 0) refuse("a group cannot be listed", "the file may be damaged");
  const Hdf5Handle properties(H5Gget_create_plist(group), H5Pclose);
  unsigned order = 0;
  if (properties.valid()) H5Pget_link_creation_order(properties, &order);
  std::vector<std::string> found;
  const auto collect = [](hid_t, const char* name, const H5L_info_t*, void* out) -> herr_t {
    static_cast<std::vector<std::string>*>(out)->emplace_back(name);
    return 0;
  };
  const H5_index_t by = (order & H5P_CRT_ORDER_TRACKED) != 0 ? H5_INDEX_CRT_ORDER : H5_INDEX_NAME;
  if (H5Literate(group, by, H5_ITER_INC, nullptr, collect, &found) < 0)
    refuse("a group cannot be listed", "the file may be damaged");
  return found;
}

std::string Hdf5Input::text_attribute(hid_t group, const char* name) const {
  if (H5Aexists(group, name) <= 0) refuse(fmt::format("attribute {} is missing", in_quotes(name)));
  const Hdf5Handle attribute(H5Aopen(group, name, H5P_DEFAULT), H5Aclose);
  const Hdf5Handle type(attribute.valid() ? H5Aget_type(attribute) : -1, H5Tclose);
  const Hdf5Handle space(attribute.valid() ? H5Aget_space(attribute) : -1, H5Sclose);
  if (!type.valid() || !space.valid() || H5Tget_class(type) != H5T_STRING || H5Sget_simple_extent_npoints(space) != 1) {
    refuse(fmt::format("attribute {} is not a string", in_quotes(name)));
  }
  if (H5Tis_variable_str(type) > 0) {
    char* text = nullptr;
    if (H5Aread(attribute, type, &text) < 0 || text == nullptr)
      refuse(fmt::format("attribute {} cannot be read", in_quotes(name)));
    std::string out(text, strnlen(text, kLongestText));
    H5Dvlen_reclaim(type, space, H5P_DEFAULT, &text);
    return out;
  }
  const std::size_t size = H5Tget_size(type);
  if (size == 0 || size > kLongestText)
    refuse(fmt::format("attribute {} has {} letters", in_quotes(name), size), "256 at most");
  std::string out(size, '\0');
  if (H5Aread(attribute, type, out.data()) < 0) refuse(fmt::format("attribute {} cannot be read", in_quotes(name)));
  out.resize(strnlen(out.data(), size));
  return out;
}

std::vector<std::int64_t> Hdf5Input::integer_attribute(hid_t group, const char* name) const {
  if (H5Aexists(group, name) <= 0) refuse(fmt::format("attribute {} is missing", in_quotes(name)));
  const Hdf5Handle attribute(H5Aopen(group, name, H5P_DEFAULT), H5Aclose);
  const Hdf5Handle type(attribute.valid() ? H5Aget_type(attribute) : -1, H5Tclose);
  const Hdf5Handle space(attribute.valid() ? H5Aget_space(attribute) : -1, H5Sclose);
  constexpr hssize_t kMost = 64;
  const hssize_t count = space.valid() ? H5Sget_simple_extent_npoints(space) : -1;
  if (!type.valid() || !is_plain_number(type, true) || count < 1 || count > kMost) {
    refuse(fmt::format("attribute {} does not hold whole numbers", in_quotes(name)));
  }
  std::vector<std::int64_t> out(static_cast<std::size_t>(count));
  if (H5Aread(attribute, H5T_NATIVE_INT64, out.data()) < 0)
    refuse(fmt::format("attribute {} cannot be read", in_quotes(name)));
  return out;
}

bool Hdf5Input::is_numeric(hid_t group, const char* name) const {
  if (!is_object(group, name, H5O_TYPE_DATASET)) return false;
  const Hdf5Handle data(H5Dopen2(group, name, H5P_DEFAULT), H5Dclose);
  const Hdf5Handle type(data.valid() ? H5Dget_type(data) : -1, H5Tclose);
  return type.valid() && is_plain_number(type, false);
}

template <class T>
Hdf5Input::Table<T> Hdf5Input::dataset(hid_t group, const char* name) {
  constexpr bool kIntegers = std::is_integral_v<T>;
  const std::string label = "dataset " + in_quotes(name);
  if (!has(group, name)) refuse(label + " is missing");
  if (!is_object(group, name, H5O_TYPE_DATASET)) refuse(label + " is not a dataset of this file");
  const Hdf5Handle data(H5Dopen2(group, name, H5P_DEFAULT), H5Dclose);
  if (!data.valid()) refuse(label + " cannot be opened", "the file may be damaged");
  const Hdf5Handle type(H5Dget_type(data), H5Tclose);
  if (!type.valid() || !is_plain_number(type, kIntegers))
    refuse(label + (kIntegers ? " does not hold whole numbers" : " does not hold numbers"));
  const Hdf5Handle space(H5Dget_space(data), H5Sclose);
  const int rank = space.valid() ? H5Sget_simple_extent_ndims(space) : -1;
  if (rank != 1 && rank != 2) refuse(fmt::format("{} has {} dimensions", label, rank), "1 or 2");
  std::array<hsize_t, 2> size{0, 1};
  if (H5Sget_simple_extent_dims(space, size.data(), nullptr) < 0)
    refuse(label + " has no size", "the file may be damaged");
  if (!is_plain_storage(data))
    refuse(label + " is stored in a way that is not read", "write it contiguous, or chunked with gzip");
  if (size[1] == 0 || size[0] > budget_ / sizeof(T) / size[1]) {
    refuse(fmt::format("{} promises {} times {} values, far more than a file of its size should hold", label, size[0],
                       size[1]),
           "the file may be cut short or damaged");
  }
  const std::size_t count = size[0] * size[1];
  budget_ -= count * sizeof(T);
  Table<T> out;
  out.columns = size[1];
  out.values.values.resize(count);
  const hid_t memory = kIntegers ? H5T_NATIVE_INT64 : H5T_NATIVE_DOUBLE;
  if (count > 0 && H5Dread(data, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, out.values.values.data()) < 0) {
    refuse(label + " cannot be read", "the file may be cut short or damaged");
  }
  return out;
}
template Hdf5Input::Table<double> Hdf5Input::dataset(hid_t, const char*);
template Hdf5Input::Table<std::int64_t> Hdf5Input::dataset(hid_t, const char*);

}  // namespace rhexis::mesh::io
