#pragma once

/// Which file of ours a request means, if any: nothing outside of the page's folder and the recordings made known.

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "base/error.h"

namespace rhexis::server {

struct ServedFile {
  std::filesystem::path path;
  std::string type;  ///< of its content
  std::string tag;   ///< changes when the file does
  std::uint64_t bytes = 0;
  bool download = false;  ///< to be saved, not shown
};

class ServedFiles {
 public:
  /// Errors: no such folder, no index.html in it.
  static Expected<ServedFiles> open(const std::filesystem::path& page, const std::filesystem::path& recordings);

  /// From now on this file of the recordings' folder can be fetched. A name that is none is ignored.
  void add_recording(const std::string& name);

  /// `target`: "/path?query" as it came. Nothing: there is no such file.
  [[nodiscard]] std::optional<ServedFile> find(std::string_view target) const;

 private:
  std::filesystem::path page_;  ///< canonical
  std::filesystem::path recordings_;
  std::set<std::string> recorded_;
};

}  // namespace rhexis::server
