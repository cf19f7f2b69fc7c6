#include "fuzz/mesh_target.h"
#include "mesh/io/gzip.h"

// The first bit chooses: the bytes as a .gz file, or packed here so that mutations reach the reader behind.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace rhexis::mesh::io;
  if (size == 0) return 0;
  const std::string_view bytes = rhexis::fuzz::as_text(data + 1, size - 1);
  rhexis::fuzz::check_mesh(parse_mesh((data[0] & 1) != 0 ? gzip(bytes) : std::string(bytes), "fuzz.msh.gz"));
  return 0;
}
