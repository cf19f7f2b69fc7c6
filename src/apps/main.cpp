// rhexis COMMAND ...
//
//   rhexis solve scenes/vessel.toml --out out/vessel --set model.beta=auto
//   rhexis check scenes/vessel.toml
//   rhexis compare out/a out/b
//   rhexis mesh info vessel.msh

#include <cstdio>
#include <exception>

#include "apps/command.h"
#include "apps/command_words.h"
#include "linalg/blas_kernels.h"

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

/// What all commands have in common stands in the help of each.
void mention_common_options(CLI::App& app) {
  for (CLI::App* command : app.get_subcommands({})) {
    command->footer(command->get_footer() + "\nAlso: --json, -q, --quiet, -v, --verbose (`rhexis --help`)");
    mention_common_options(*command);
  }
}

int run(int argc, char** argv) {
  CLI::App app(
      "Soft tissue that bends, bulges and tears: finite elements on linear tetrahedra, in numbers one can check.",
      "rhexis");
  app.set_version_flag("--version", std::string("rhexis ") + RHEXIS_VERSION);
  app.footer("Example: rhexis solve scenes/vessel.toml --out out/vessel");
  app.require_subcommand(1);
  app.fallthrough();
  Common common;
  app.add_flag("--json", common.json, "print the summary as JSON on stdout, and nothing else there");
  app.add_flag("-v,--verbose", common.verbose, "say more");
  app.add_flag("-q,--quiet", common.quiet, "nothing on stdout but what --json asks for; errors only on stderr");

  int code = kDone;
  add_solve(app, common, code);
  add_tear(app, common, code);
  add_precompute(app, common, code);
  add_play(app, common, code);
  add_replay(app, common, code);
  add_devices(app, common, code);
  add_check(app, common, code);
  add_compare(app, common, code);
  add_mesh(app, common, code);
  add_study(app, common, code);
  add_scene_reference(app, common, code);
  mention_common_options(app);

  app.parse_complete_callback([&] {
    set_up_log(common.verbose ? Verbosity::verbose : common.quiet ? Verbosity::quiet : Verbosity::normal);
  });
  const CommandWords words = read_command_words(app, argc, argv);
  if (!words.wrong.empty()) {
    fmt::print(stderr, "rhexis: {}\n", words.wrong);
    return kBadInput;
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success))
      return app.exit(error);  // --help, --version
    fmt::print(stderr, "rhexis: {} (see `{} --help`)\n", error.what(), words.command);
    return kBadInput;
  }
  return code;
}

}  // namespace
}  // namespace rhexis::apps

int main(int argc, char** argv) {
  rhexis::linalg::begin_with_fitting_blas(argv);
  try {
    return rhexis::apps::run(argc, argv);
  } catch (const std::bad_alloc&) {
    std::fputs("rhexis: out of memory (a smaller mesh, or linear = \"cg\", needs less)\n", stderr);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "rhexis: unexpected: %s\n", error.what());
  }
  return rhexis::apps::kFailedComputation;
}
