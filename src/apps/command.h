#pragma once

/// What the subcommands share: how they end and how they speak.

#include <CLI/CLI.hpp>
#include <string>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/log.h"
#include "base/vec.h"

namespace rhexis::apps {

/// Exit codes of every command.
inline constexpr int kDone = 0;
inline constexpr int kFailedComputation = 1;
inline constexpr int kBadInput = 2;

/// Options that every command has.
struct Common {
  bool json = false;  ///< the summary on stdout, and nothing else there
  bool verbose = false;
  bool quiet = false;
};

/// Prints `rhexis: FILE:LINE: what (remedy)` to stderr. Returns kBadInput.
int report(const Error& error);

/// Text for people on stdout, left out with --json.
template <class... Args>
void say(const Common& common, fmt::format_string<Args...> format, Args&&... args) {
  if (!common.json && !common.quiet) fmt::print(format, std::forward<Args>(args)...);
}

/// The one thing that --json prints.
void print_json(const nlohmann::ordered_json& json);

[[nodiscard]] inline nlohmann::ordered_json vector_json(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

/// Each adds its subcommand to the app and writes its exit code to `code` when it has run.
void add_solve(CLI::App& app, const Common& common, int& code);
void add_tear(CLI::App& app, const Common& common, int& code);
void add_precompute(CLI::App& app, const Common& common, int& code);
void add_play(CLI::App& app, const Common& common, int& code);
void add_replay(CLI::App& app, const Common& common, int& code);
void add_devices(CLI::App& app, const Common& common, int& code);
void add_check(CLI::App& app, const Common& common, int& code);
void add_compare(CLI::App& app, const Common& common, int& code);
void add_mesh(CLI::App& app, const Common& common, int& code);
void add_study(CLI::App& app, const Common& common, int& code);
void add_scene_reference(CLI::App& app, const Common& common, int& code);

}  // namespace rhexis::apps
