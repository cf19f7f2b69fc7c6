#include "fuzz/mesh_target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  rhexis::fuzz::check_mesh(rhexis::mesh::io::parse_vtu(rhexis::fuzz::as_text(data, size), "fuzz.vtu"));
  return 0;
}
