#include "apps/beside_program.h"

#include <fstream>
#include <system_error>

namespace rhexis::apps {

std::filesystem::path share_folder() {
  std::error_code error;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
  return program.parent_path().parent_path() / "share/rhexis";
}

std::string command_line() {
  std::ifstream file("/proc/self/cmdline", std::ios::binary);
  std::string word;
  std::getline(file, word, '\0');  // the program, wherever it lies
  std::string out = "rhexis";
  while (std::getline(file, word, '\0'))
    out += word.find_first_of(" '\"") == std::string::npos ? " " + word : " '" + word + "'";
  return out;
}

}  // namespace rhexis::apps
