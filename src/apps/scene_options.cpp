#include "apps/scene_options.h"

#include "base/log.h"
#include "base/parallel.h"

namespace rhexis::apps {

namespace fs = std::filesystem;

fs::path SceneOptions::folder() const { return out.empty() ? fs::path("out") / fs::path(scene).stem() : fs::path(out); }

std::shared_ptr<SceneOptions> add_scene_options(CLI::App& command) {
  auto options = std::make_shared<SceneOptions>();
  command.add_option("scene", options->scene, "scene file (docs/scene.md)")->required();
  command
      .add_option("--set", options->overrides,
                  "override a value of the scene, as often as wanted; KEY= takes the key out")
      ->type_name("KEY=VALUE")
      ->expected(1)
      ->take_all();
  return options;
}

void add_out_option(CLI::App& command, SceneOptions& options) {
  command.add_option("--out", options.out, "folder for the results; out/<scene> unless given");
}

Expected<scene::Scene> read_scene(const SceneOptions& options) {
  Expected<scene::Scene> scene = scene::read_scene(options.scene, options.overrides);
  if (scene) set_thread_count(scene->solver.threads);
  return scene;
}

void log_remarks(const std::vector<std::string>& notes, const std::vector<std::string>& warnings) {
  for (const std::string& note : notes) spdlog::info("{}", note);
  for (const std::string& warning : warnings) spdlog::warn("{}", warning);
}

}  // namespace rhexis::apps
