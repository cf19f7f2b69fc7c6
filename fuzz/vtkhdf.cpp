#include "fuzz/mesh_target.h"

// HDF5 1.10.8 crashes inside the library on hostile files (H5Aexists reads behind a group's attributes, say), where no
// check of ours can come before it. tools/run_fuzz.sh therefore searches on, looks at each crash afterwards, and fails
// only for those that are surely ours.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  rhexis::fuzz::check_mesh(rhexis::mesh::io::parse_vtkhdf(rhexis::fuzz::as_text(data, size), "fuzz.vtkhdf"));
  return 0;
}
