#pragma once

/// Runs the built program as a user would.

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <system_error>

#include <sys/wait.h>
#include <unistd.h>

namespace rhexis::test {

struct Ran {
  int code = -1;
  std::string out;
  std::string err;
};

inline std::string slurp(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

/// The folder of this test program; gone when it ends.
inline const std::filesystem::path& folder_of_the_program() {
  struct Folder {
    std::filesystem::path path = std::filesystem::temp_directory_path() / ("rhexis-" + std::to_string(::getpid()));
    ~Folder() {
      std::error_code ignored;
      std::filesystem::remove_all(path, ignored);
    }
  };
  static const Folder folder;
  return folder.path;
}

/// A folder of its own for one test, emptied first.
inline std::filesystem::path fresh_folder(const std::string& name) {
  const std::filesystem::path folder = folder_of_the_program() / name;
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  return folder;
}

/// `rhexis ARGUMENTS`, from the project's root.
inline Ran run_rhexis(const std::string& arguments) {
  const std::filesystem::path folder = fresh_folder("streams");
  const std::string line = "cd '" RHEXIS_SOURCE_DIR "' && '" RHEXIS_COMMAND "' " + arguments + " >'" +
                           (folder / "out").string() + "' 2>'" + (folder / "err").string() + "' </dev/null";
  const int status = std::system(line.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, slurp(folder / "out"), slurp(folder / "err")};
}

}  // namespace rhexis::test
