#include "session/recording_scene.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace rhexis::session {
namespace {

using Json = nlohmann::ordered_json;

const SceneChoice kScene{.file = "a.toml", .text = std::string("title\0\xff", 7), .overrides = {"a=1", ""}};

Json binary(const std::string& text) { return Json::binary({text.begin(), text.end()}); }

TEST(RecordedScene, ComesBackByteByByte) {
  const Expected<SceneChoice> scene = parse_scene_choice(bytes_of(kScene));
  ASSERT_TRUE(scene.has_value());
  EXPECT_EQ(scene->file, kScene.file);
  EXPECT_EQ(scene->text, kScene.text);
  EXPECT_EQ(scene->overrides, kScene.overrides);
}

TEST(RecordedScene, KeepsItsMeshFile) {
  SceneChoice with_mesh = kScene;
  with_mesh.mesh = std::make_shared<MeshBytes>(MeshBytes{.file = "folder/a.msh", .bytes = std::string("\0mesh", 5)});
  const Expected<SceneChoice> scene = parse_scene_choice(bytes_of(with_mesh));
  ASSERT_TRUE(scene.has_value());
  ASSERT_NE(scene->mesh, nullptr);
  EXPECT_EQ(scene->mesh->file, with_mesh.mesh->file);
  EXPECT_EQ(scene->mesh->bytes, with_mesh.mesh->bytes);
  for (const char* half : {"mesh", "mesh_file"}) {
    Json json = Json::from_cbor(bytes_of(with_mesh));
    json.erase(half);
    EXPECT_FALSE(parse_scene_choice(Json::to_cbor(json)).has_value()) << half;
  }
}

TEST(RecordedScene, NamesItsRecord) {
  SceneChoice with_record = kScene;
  with_record.record = 0x0123456789abcdefULL;
  const Expected<SceneChoice> scene = parse_scene_choice(bytes_of(with_record));
  ASSERT_TRUE(scene.has_value());
  EXPECT_EQ(scene->record, with_record.record);
  EXPECT_EQ(parse_scene_choice(bytes_of(kScene))->record, 0U);
  for (const char* bad : {"", "0123", "0123456789abcdeg", "0123456789abcdef0", "-123456789abcdef"}) {
    Json json = Json::from_cbor(bytes_of(with_record));
    json["record"] = binary(bad);
    EXPECT_FALSE(parse_scene_choice(Json::to_cbor(json)).has_value()) << bad;
  }
}

TEST(RecordedScene, CutOffOrOfAnotherFormIsRefused) {
  const std::vector<std::uint8_t> whole = bytes_of(kScene);
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_FALSE(parse_scene_choice(std::span(whole).first(size)).has_value()) << size;
  const Json good{{"file", binary("a")}, {"text", binary("b")}, {"overrides", Json::array({binary("c")})}};
  ASSERT_TRUE(parse_scene_choice(Json::to_cbor(good)).has_value());
  const auto refused = [&](const std::string& key, const Json& value) {
    Json other = good;
    other[key] = value;
    return !parse_scene_choice(Json::to_cbor(other)).has_value();
  };
  EXPECT_TRUE(refused("file", "text"));
  EXPECT_TRUE(refused("file", Json::array({binary("c")})));
  EXPECT_TRUE(refused("text", nullptr));
  EXPECT_TRUE(refused("overrides", binary("c")));
  EXPECT_TRUE(refused("overrides", Json::array({7})));
  EXPECT_TRUE(refused("overrides", Json::array({Json::array({binary("c")})})));
  EXPECT_TRUE(refused("more", binary("c")));
  for (const Json& other : {Json(), Json(1.5), binary("c"), Json::array({good}), Json::object()})
    EXPECT_FALSE(parse_scene_choice(Json::to_cbor(other)).has_value());
}

TEST(RecordedScene, NestedWithoutEndIsRefusedAndDoesNotExhaustTheStack) {
  constexpr std::uint8_t kListOfOne = 0x81;
  constexpr std::uint8_t kMapOfOne = 0xa1;
  for (const std::uint8_t opens : {kListOfOne, kMapOfOne}) {
    std::vector<std::uint8_t> bytes{kMapOfOne, 0x69};  // {"overrides": ...
    for (const char letter : std::string("overrides")) bytes.push_back(static_cast<std::uint8_t>(letter));
    bytes.resize(bytes.size() + 10'000'000, opens);
    EXPECT_FALSE(parse_scene_choice(bytes).has_value());
  }
}

}  // namespace
}  // namespace rhexis::session
