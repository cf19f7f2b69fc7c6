#include "session/recording_scene.h"

#include <nlohmann/json.hpp>

namespace rhexis::session {

using Json = nlohmann::ordered_json;

/// CBOR, which keeps texts as they are, whatever their bytes.
std::vector<std::uint8_t> bytes_of(const SceneChoice& scene) {
  const auto binary = [](const std::string& text) {
    return Json::binary(std::vector<std::uint8_t>(text.begin(), text.end()));
  };
  Json overrides = Json::array();
  for (const std::string& override : scene.overrides) overrides.push_back(binary(override));
  return Json::to_cbor(
      {{"file", binary(scene.file)}, {"text", binary(scene.text)}, {"overrides", std::move(overrides)}});
}

Expected<SceneChoice> parse_scene_choice(std::span<const std::uint8_t> bytes) {
  const Json json = Json::from_cbor(bytes.begin(), bytes.end(), /*strict=*/true, /*allow_exceptions=*/false);
  const auto read = [](const Json& value, std::string& out) {
    if (value.is_binary()) out.assign(value.get_binary().begin(), value.get_binary().end());
    return value.is_binary();
  };
  SceneChoice scene;
  const bool whole = json.is_object() && json.contains("file") && read(json["file"], scene.file) &&
                     json.contains("text") && read(json["text"], scene.text) && json.contains("overrides") &&
                     json["overrides"].is_array();
  if (!whole) return fail("a scene in it cannot be read");
  for (const Json& override : json["overrides"]) {
    scene.overrides.emplace_back();
    if (!read(override, scene.overrides.back())) return fail("a scene in it cannot be read");
  }
  return scene;
}

}  // namespace rhexis::session
