#include "base/atomic_file.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

#include <unistd.h>

namespace rhexis {
namespace fs = std::filesystem;

Expected<void> write_atomically(const fs::path& path, const std::function<Expected<void>(const fs::path&)>& write) {
  std::error_code code;
  if (path.has_parent_path()) {
    fs::create_directories(path.parent_path(), code);
    if (code) return fail("cannot make folder '" + path.parent_path().string() + "': " + code.message());
  }
  // The process id keeps two runs into one folder from sharing a temporary.
  const fs::path temporary = path.string() + ".part" + std::to_string(::getpid());
  Expected<void> written = write(temporary);
  if (!written) {
    fs::remove(temporary, code);
    return written;
  }
  fs::rename(temporary, path, code);
  if (code) {
    const std::string reason = code.message();
    fs::remove(temporary, code);
    return fail("cannot write: " + reason, "choose a folder that can be written to", path.string());
  }
  return {};
}

Expected<void> write_atomically(const fs::path& path, std::string_view contents) {
  return write_atomically(path, [&](const fs::path& temporary) -> Expected<void> {
    errno = 0;
    std::ofstream file(temporary, std::ios::binary);
    file.write(contents.data(), static_cast<std::streamsize>(contents.size()));
    file.close();
    if (!file)
      return fail(std::string("cannot write: ") + std::strerror(errno), "choose a folder that can be written to",
                  path.string());
    return {};
  });
}

}  // namespace rhexis
