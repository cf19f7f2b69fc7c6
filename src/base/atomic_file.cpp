#include "base/atomic_file.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

#include <unistd.h>

namespace rhexis {
namespace fs = std::filesystem;
namespace {

/// Between the name of a file and the id of the process that writes it: two runs into one folder share no temporary.
constexpr std::string_view kTemporary = ".part";

}  // namespace

Expected<void> write_atomically(const fs::path& path, const std::function<Expected<void>(const fs::path&)>& write) {
  std::error_code code;
  if (path.has_parent_path()) {
    fs::create_directories(path.parent_path(), code);
    if (code)
      return fail("cannot make the folder: " + code.message(), "choose a folder that can be written to",
                  path.parent_path().string());
  }
  const fs::path temporary = path.string() + std::string(kTemporary) + std::to_string(::getpid());
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

std::string_view finished_name(std::string_view name) {
  const std::size_t end = name.rfind(kTemporary);
  if (end == std::string_view::npos) return name;
  const std::string_view id = name.substr(end + kTemporary.size());
  const bool is_id = !id.empty() && id.find_first_not_of("0123456789") == std::string_view::npos;
  return is_id ? name.substr(0, end) : name;
}

}  // namespace rhexis
