#include "mesh/io/hdf5_scalars.h"

#include <algorithm>
#include <array>
#include <fstream>

namespace rhexis::mesh::io {
namespace {

constexpr std::size_t kLongestText = std::size_t{1} << 16;

}  // namespace

bool has_hdf5_signature(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::array<char, 8> start{};
  stream.read(start.data(), start.size());
  constexpr std::array<char, 8> kSignature{'\x89', 'H', 'D', 'F', '\r', '\n', '\x1a', '\n'};
  return stream.gcount() == 8 && start == kSignature;
}

std::string text_attribute(hid_t in, const char* name) {
  if (H5Aexists(in, name) <= 0) return {};
  const Hdf5Handle attribute(H5Aopen(in, name, H5P_DEFAULT), H5Aclose);
  const Hdf5Handle type(attribute.valid() ? H5Aget_type(attribute) : -1, H5Tclose);
  if (!type.valid() || H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) != 0) return {};
  const Hdf5Handle space(H5Aget_space(attribute), H5Sclose);
  if (!space.valid() || H5Sget_simple_extent_type(space) != H5S_SCALAR) return {};
  const std::size_t size = H5Tget_size(type);
  if (size == 0 || size > kLongestText) return {};
  std::string text(size, '\0');
  if (H5Aread(attribute, type, text.data()) < 0) return {};
  return text.substr(0, text.find('\0'));
}

bool set_text_attribute(hid_t in, const char* name, const std::string& text) {
  const Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type, std::max<std::size_t>(1, text.size()));  // HDF5 has no string of no size
  const Hdf5Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Hdf5Handle attribute(H5Acreate2(in, name, type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  return attribute.valid() && H5Awrite(attribute, type, text.c_str()) >= 0;
}

}  // namespace rhexis::mesh::io
