#pragma once

/// The command line read word by word before CLI11 does: CLI11 says of a wrong command that one is required, and of a
/// wrong option that it was not expected together with all that follows.

#include <CLI/CLI.hpp>
#include <string>

namespace rhexis::apps {

struct CommandWords {
  std::string command;  ///< the command as far as its words are known, "rhexis mesh make"; `--help` of it exists
  std::string wrong;  ///< one line that names the first wrong or missing word and what helps; empty when there is none
};

/// Names of commands and options only; numbers of arguments and their values are left to CLI11.
[[nodiscard]] CommandWords read_command_words(const CLI::App& app, int argc, char** argv);

}  // namespace rhexis::apps
