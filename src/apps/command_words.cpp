#include "apps/command_words.h"

#include <algorithm>
#include <cctype>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "base/nearest_name.h"

namespace rhexis::apps {
namespace {

std::vector<std::string> command_names(const CLI::App& level) {
  std::vector<std::string> names;
  for (const CLI::App* command : level.get_subcommands({})) names.push_back(command->get_name());
  return names;
}

/// `-2.5` is a value; no option begins with a digit.
bool is_option(std::string_view word) {
  return word.size() > 1 && word[0] == '-' && word[1] != '.' && std::isdigit(static_cast<unsigned char>(word[1])) == 0;
}

/// Options of a command are its own and those of the commands above it. `word` without `=value`; null when there is
/// none.
const CLI::Option* find_option(const CLI::App& level, const std::string& word) {
  const std::string name = word.starts_with("--") ? word : word.substr(0, 2);  // -qv is -q and -v
  for (const CLI::App* at = &level; at != nullptr; at = at->get_parent())
    if (const CLI::Option* option = at->get_option_no_throw(name)) return option;
  return nullptr;
}

std::vector<std::string> option_names(const CLI::App& level) {
  std::vector<std::string> names;
  for (const CLI::App* at = &level; at != nullptr; at = at->get_parent())
    for (const CLI::Option* option : at->get_options())
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

std::string remedy(const std::string& word, const std::vector<std::string>& names, const std::string& command) {
  const std::string near = nearest_name(word, names);
  return near.empty() ? "see `" + command + " --help`" : "did you mean '" + near + "'?";
}

}  // namespace

CommandWords read_command_words(const CLI::App& app, int argc, char** argv) {
  const CLI::App* level = &app;
  std::string command = app.get_name();
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--") break;
    if (is_option(word)) {
      const std::string name = word.substr(0, word.find('='));
      const CLI::Option* option = find_option(*level, name);
      if (option == nullptr)
        return {command, fmt::format("unknown option '{}' ({})", name, remedy(name, option_names(*level), command))};
      if (option == level->get_help_ptr() || option == app.get_version_ptr()) return {command, {}};
      // The value that follows may look like anything.
      if (name == word) i += option->get_items_expected_min();
      continue;
    }
    const std::vector<std::string> names = command_names(*level);
    if (names.empty()) continue;  // an argument of the command
    if (std::find(names.begin(), names.end(), word) == names.end())
      return {command, fmt::format("unknown command '{}' ({})", word, remedy(word, names, command))};
    level = level->get_subcommand(word);
    command += " " + word;
  }
  if (const std::vector<std::string> names = command_names(*level); !names.empty())
    return {command,
            fmt::format("`{}` needs a command: {} (see `{} --help`)", command, fmt::join(names, ", "), command)};
  return {command, {}};
}

}  // namespace rhexis::apps
