#include "scene/live_keys.h"

#include <nlohmann/json.hpp>

#include "tests/scene/scene_text.h"

namespace rhexis::scene {
namespace {

using nlohmann::json;

TEST(LiveKeys, NameWhatAPanelCanSetWithUnitAndRange) {
  const json keys = json::parse(live_keys_json());
  const auto find = [&](const std::string& name) {
    for (const json& key : keys)
      if (key["key"] == name) return key;
    return json();
  };
  EXPECT_EQ(find("material.young")["unit"], "Pa");
  EXPECT_EQ(find("material.young")["min"], 1e-3);
  EXPECT_EQ(find("material.young")["kind"], "number");
  EXPECT_EQ(find("fracture.criterion")["choices"].size(), 4U);
  EXPECT_EQ(find("fracture.ahead_only")["kind"], "boolean");
  EXPECT_EQ(find("mesh.nodes")["kind"], "integer");
  EXPECT_TRUE(find("support.0.x").is_null());
  EXPECT_TRUE(find("mesh.size").is_null());
  EXPECT_TRUE(find("interaction.response").is_null());
}

TEST(LiveKeys, EveryKeyHasItsPresentValueAndCanBeSetToIt) {
  const json keys = json::parse(live_keys_json());
  const Expected<std::string> text = live_values_json(test::kGood, "s.toml", {"material.young=2e6"});
  ASSERT_TRUE(text.has_value()) << text.error().message();
  const json values = json::parse(*text);
  EXPECT_EQ(values.size(), keys.size());
  EXPECT_EQ(values["material.young"], 2e6);
  EXPECT_EQ(values["mesh.nodes"], 200);
  EXPECT_EQ(values["model.kind"], "hyperelastic");
  EXPECT_TRUE(values["fracture.strength"].is_null());
  for (const auto& [key, value] : values.items()) {
    if (value.is_null() || key.starts_with("fracture")) continue;
    EXPECT_EQ(test::message_of(test::kGood, {key + '=' + value.dump()}), "good") << key;
  }
}

TEST(LiveKeys, AWrongSceneIsSaidAsEverywhere) {
  const Expected<std::string> values = live_values_json(test::kGood, "s.toml", {"material.young=-1"});
  ASSERT_FALSE(values.has_value());
  EXPECT_EQ(values.error().message(), test::message_of(test::kGood, {"material.young=-1"}));
}

}  // namespace
}  // namespace rhexis::scene
