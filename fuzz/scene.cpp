// Any text as a scene; what comes after the first NUL byte, line by line, as overrides. Nothing is built: the mesh
// would be a file of this machine, or as large as the scene asks for.

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "scene/scene.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string all(reinterpret_cast<const char*>(data), size);
  const std::size_t end = all.find('\0');
  std::vector<std::string> overrides;
  if (end != std::string::npos) {
    for (std::size_t begin = end + 1; begin < all.size();) {
      const std::size_t stop = std::min(all.find('\n', begin), all.size());
      overrides.push_back(all.substr(begin, stop - begin));
      begin = stop + 1;
    }
  }
  const auto scene = rhexis::scene::parse_scene(all.substr(0, end), "fuzz.toml", overrides);
  if (!scene && scene.error().message().find('\n') != std::string::npos) __builtin_trap();  // errors are one line
  return 0;
}
