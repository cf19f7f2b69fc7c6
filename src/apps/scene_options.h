#pragma once

/// The arguments that every command on a scene takes.

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "apps/command.h"
#include "scene/scene.h"

namespace rhexis::apps {

struct SceneOptions {
  std::string scene;
  std::string out;
  std::vector<std::string> overrides;

  /// `out` where it was given, else out/<scene>.
  [[nodiscard]] std::filesystem::path folder() const;
};

/// The scene and `--set`.
[[nodiscard]] std::shared_ptr<SceneOptions> add_scene_options(CLI::App& command);
/// `--out` beside them.
void add_out_option(CLI::App& command, SceneOptions& options);

/// Reads the scene and sets the number of threads that it asks for.
[[nodiscard]] Expected<scene::Scene> read_scene(const SceneOptions& options);

/// What was noted and warned of, to the log.
void log_remarks(const std::vector<std::string>& notes, const std::vector<std::string>& warnings);

}  // namespace rhexis::apps
