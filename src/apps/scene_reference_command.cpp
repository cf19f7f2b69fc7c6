// rhexis scene-reference: the keys of a scene from the declarations that validate it.

#include "apps/command.h"
#include "scene/reference.h"

namespace rhexis::apps {

void add_scene_reference(CLI::App& app, const Common& common, int& code) {
  CLI::App* command =
      app.add_subcommand("scene-reference", "Print every key of a scene, as Markdown or as a JSON Schema for editors");
  command->footer("Example: rhexis scene-reference --schema > scene.schema.json");
  auto schema = std::make_shared<bool>(false);
  command->add_flag("--schema", *schema, "the JSON Schema, which --json prints too");
  command->callback([schema, &common, &code] {
    if (common.json || (*schema && !common.quiet))
      fmt::print("{}", scene::scene_json_schema());
    else
      say(common, "{}", scene::scene_reference_markdown());
    code = kDone;
  });
}

}  // namespace rhexis::apps
