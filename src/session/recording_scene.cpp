#include "session/recording_scene.h"

#include <charconv>
#include <optional>
#include <set>
#include <utility>

#include <nlohmann/json.hpp>

namespace rhexis::session {

using Json = nlohmann::ordered_json;

namespace {

/// Takes the one form that bytes_of writes, and stops at anything else: the library reads what is nested by recursion,
/// as deep as a file of a stranger asks for.
class SceneReader final : public nlohmann::json_sax<Json> {
 public:
  bool start_object(std::size_t /*count*/) override { return !std::exchange(begun_, true); }
  bool end_object() override { return true; }
  bool key(std::string& name) override {
    key_ = name;
    return seen_.insert(name).second;
  }
  bool start_array(std::size_t /*count*/) override {
    if (in_list_ || key_ != "overrides") return false;
    in_list_ = true;
    return true;
  }
  bool end_array() override {
    in_list_ = false;
    return true;
  }
  bool binary(Json::binary_t& value) override {
    std::string* const to = place();
    if (to != nullptr) to->assign(value.begin(), value.end());
    return to != nullptr;
  }
  bool null() override { return false; }
  bool boolean(bool /*value*/) override { return false; }
  bool number_integer(std::int64_t /*value*/) override { return false; }
  bool number_unsigned(std::uint64_t /*value*/) override { return false; }
  bool number_float(double /*value*/, const std::string& /*text*/) override { return false; }
  bool string(std::string& /*value*/) override { return false; }
  bool parse_error(std::size_t /*at*/, const std::string& /*token*/, const Json::exception& /*what*/) override {
    return false;
  }

  /// Empty: something is missing.
  [[nodiscard]] std::optional<SceneChoice> scene() {
    if (seen_.erase("record") == 1) {
      const char* const end = record_.data() + record_.size();
      const auto [stop, error] = std::from_chars(record_.data(), end, scene_.record, 16);
      if (record_.size() != 16 || stop != end || error != std::errc()) return {};
    }
    const std::size_t of_mesh = seen_.erase("mesh_file") + seen_.erase("mesh");
    if (seen_ != std::set<std::string>{"file", "text", "overrides"} || of_mesh == 1) return {};
    if (of_mesh == 2)
      scene_.mesh = std::make_shared<MeshBytes>(MeshBytes{.file = mesh_file_, .bytes = std::move(mesh_)});
    return std::move(scene_);
  }

 private:
  std::string* place() {
    if (in_list_) return &scene_.overrides.emplace_back();
    if (key_ == "file") return &scene_.file;
    if (key_ == "mesh_file") return &mesh_file_;
    if (key_ == "mesh") return &mesh_;
    if (key_ == "record") return &record_;
    return key_ == "text" ? &scene_.text : nullptr;
  }

  SceneChoice scene_;
  std::string mesh_file_;
  std::string mesh_;
  std::string record_;
  std::set<std::string> seen_;
  std::string key_;
  bool begun_ = false;
  bool in_list_ = false;
};

}  // namespace

/// CBOR, which keeps texts as they are, whatever their bytes.
std::vector<std::uint8_t> bytes_of(const SceneChoice& scene) {
  const auto binary = [](const std::string& text) {
    return Json::binary(std::vector<std::uint8_t>(text.begin(), text.end()));
  };
  Json overrides = Json::array();
  for (const std::string& override : scene.overrides) overrides.push_back(binary(override));
  Json json{{"file", binary(scene.file)}, {"text", binary(scene.text)}, {"overrides", std::move(overrides)}};
  if (scene.mesh != nullptr) {
    json["mesh_file"] = binary(scene.mesh->file.string());
    json["mesh"] = binary(scene.mesh->bytes);
  }
  if (scene.record != 0) json["record"] = binary(fmt::format("{:016x}", scene.record));
  return Json::to_cbor(json);
}

Expected<SceneChoice> parse_scene_choice(std::span<const std::uint8_t> bytes) {
  SceneReader reader;
  const bool read = Json::sax_parse(bytes.begin(), bytes.end(), &reader, Json::input_format_t::cbor, /*strict=*/true);
  std::optional<SceneChoice> scene = read ? reader.scene() : std::nullopt;
  if (!scene) return fail("a scene in it cannot be read");
  return std::move(*scene);
}

}  // namespace rhexis::session
