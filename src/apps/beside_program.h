#pragma once

/// What lies beside the program, and how it was called.

#include <filesystem>
#include <string>

namespace rhexis::apps {

/// share/rhexis beside the folder of the program, where `make viewer` lays the page.
[[nodiscard]] std::filesystem::path share_folder();

/// `rhexis` and its arguments as they were typed, words with blanks in quotes.
[[nodiscard]] std::string command_line();

}  // namespace rhexis::apps
