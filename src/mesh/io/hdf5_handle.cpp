#include "mesh/io/hdf5_handle.h"

namespace rhexis::mesh::io {

Hdf5Handle open_in_memory(std::string_view image) {
  const Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  constexpr std::size_t kGrowBy = std::size_t{1} << 20;
  if (!access.valid() || H5Pset_fapl_core(access, kGrowBy, /*backing_store=*/false) < 0) return {};
  // The name is not looked up: the driver keeps all in memory.
  constexpr const char* kName = "in memory";
  if (image.empty()) return {H5Fcreate(kName, H5F_ACC_TRUNC, H5P_DEFAULT, access), H5Fclose};
  if (H5Pset_file_image(access, const_cast<char*>(image.data()), image.size()) < 0) return {};  // HDF5 copies it
  return {H5Fopen(kName, H5F_ACC_RDONLY, access), H5Fclose};
}

}  // namespace rhexis::mesh::io
