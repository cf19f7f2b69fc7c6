#include "mesh/io/hdf5_checks.h"

#include "mesh/io/hdf5_handle.h"

namespace rhexis::mesh::io {

bool is_hard_link(hid_t group, const char* name) {
  H5L_info_t info;
  return H5Lexists(group, name, H5P_DEFAULT) > 0 && H5Lget_info(group, name, &info, H5P_DEFAULT) >= 0 &&
         info.type == H5L_TYPE_HARD;
}

bool is_object(hid_t group, const char* name, H5O_type_t wanted) {
  H5O_info_t info;
  return is_hard_link(group, name) && H5Oget_info_by_name(group, name, &info, H5P_DEFAULT) >= 0 && info.type == wanted;
}

bool is_plain_storage(hid_t data) {
  const Hdf5Handle properties(H5Dget_create_plist(data), H5Pclose);
  if (!properties.valid() || H5Pget_external_count(properties) != 0) return false;
  const H5D_layout_t layout = H5Pget_layout(properties);
  if (layout != H5D_COMPACT && layout != H5D_CONTIGUOUS && layout != H5D_CHUNKED) return false;
  const int filters = H5Pget_nfilters(properties);
  for (int i = 0; i < filters; ++i) {
    unsigned flags = 0;
    std::size_t count = 0;
    const H5Z_filter_t filter =
        H5Pget_filter2(properties, static_cast<unsigned>(i), &flags, &count, nullptr, 0, nullptr, nullptr);
    if (filter != H5Z_FILTER_DEFLATE && filter != H5Z_FILTER_SHUFFLE && filter != H5Z_FILTER_FLETCHER32) return false;
  }
  return filters >= 0;
}

}  // namespace rhexis::mesh::io
