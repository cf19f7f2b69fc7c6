// rhexis COMMAND ...
//
//   rhexis solve scenes/vessel.toml --out out/vessel --set model.beta=auto
//   rhexis check scenes/vessel.toml
//   rhexis compare out/a out/b
//   rhexis mesh info vessel.msh

#include <algorithm>
#include <cstdio>
#include <exception>

#include "apps/command.h"
#include "base/nearest_name.h"

namespace rhexis::apps {

int report(const Error& error) {
  std::fflush(stdout);
  fmt::print(stderr, "rhexis: {}\n", error.message());
  return kBadInput;
}

void print_json(const nlohmann::ordered_json& json) {
  fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

namespace {

/// The first word that is no option has to be a command; CLI11 would only say that one is required. Empty when it is.
std::string unknown_command(const CLI::App& app, int argc, char** argv) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word.starts_with('-')) continue;
    if (std::find(names.begin(), names.end(), word) != names.end()) return {};
    const std::string near = nearest_name(word, names);
    return fmt::format("unknown command '{}' ({})", word,
                       near.empty() ? "see `rhexis --help`" : "did you mean '" + near + "'?");
  }
  return {};
}

int run(int argc, char** argv) {
  CLI::App app(
      "Soft tissue that bends, bulges and tears: finite elements on linear tetrahedra, in numbers one can check.",
      "rhexis");
  app.set_version_flag("--version", std::string("rhexis ") + RHEXIS_VERSION);
  app.require_subcommand(1);
  app.fallthrough();
  Common common;
  app.add_flag("--json", common.json, "print the summary as JSON on stdout, and nothing else there");
  app.add_flag("-v,--verbose", common.verbose, "say more");
  app.add_flag("-q,--quiet", common.quiet, "say nothing but errors");

  int code = kDone;
  add_solve(app, common, code);
  add_check(app, common, code);
  add_compare(app, common, code);
  add_mesh(app, common, code);
  add_scene_reference(app, code);

  app.parse_complete_callback([&] {
    set_up_log(common.verbose ? Verbosity::verbose : common.quiet ? Verbosity::quiet : Verbosity::normal);
  });
  if (const std::string unknown = unknown_command(app, argc, argv); !unknown.empty()) {
    fmt::print(stderr, "rhexis: {}\n", unknown);
    return kBadInput;
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success))
      return app.exit(error);  // --help, --version
    fmt::print(stderr, "rhexis: {} (see `rhexis --help`)\n", error.what());
    return kBadInput;
  }
  return code;
}

}  // namespace
}  // namespace rhexis::apps

int main(int argc, char** argv) {
  try {
    return rhexis::apps::run(argc, argv);
  } catch (const std::bad_alloc&) {
    std::fputs("rhexis: out of memory (a smaller mesh, or linear = \"cg\", needs less)\n", stderr);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "rhexis: unexpected: %s\n", error.what());
  }
  return rhexis::apps::kFailedComputation;
}
