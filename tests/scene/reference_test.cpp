// docs/scene.md and docs/scene.schema.json say what the declaration says. RHEXIS_UPDATE_DOCS=1 writes them anew.

#include <gmock/gmock.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>

#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "scene/declaration.h"
#include "scene/reference.h"
#include "scene/value_of.h"
#include "tests/scene/scene_text.h"

namespace rhexis::scene::test {
namespace {

using testing::HasSubstr;

void expect_file(const std::string& name, const std::string& contents) {
  const std::filesystem::path path = std::filesystem::path(RHEXIS_SOURCE_DIR) / name;
  if (std::getenv("RHEXIS_UPDATE_DOCS") != nullptr) {
    ASSERT_TRUE(write_atomically(path, contents));
  }
  std::ifstream file(path, std::ios::binary);
  const std::string stored(std::istreambuf_iterator<char>(file), {});
  EXPECT_TRUE(stored == contents) << name
                                  << " differs from the declaration; RHEXIS_UPDATE_DOCS=1 on this test writes it";
}

TEST(Reference, DocumentIsUpToDate) { expect_file("docs/scene.md", scene_reference_markdown()); }
TEST(Reference, SchemaIsUpToDate) { expect_file("docs/scene.schema.json", scene_json_schema()); }

TEST(Reference, ExampleIsAGoodScene) {
  const Expected<Scene> scene = parse_scene(scene_reference_example(), "example.toml");
  ASSERT_TRUE(scene) << scene.error().message();
  EXPECT_THAT(scene->warnings, testing::IsEmpty());
}

TEST(Reference, ExampleShowsEverySection) {
  for (const Section& section : scene_sections().subspan(1)) {
    const std::string header = section.form == SectionForm::named ? "[" + section.name + "." : header_of(section);
    EXPECT_THAT(scene_reference_example(), HasSubstr("\n" + header)) << section.name;
  }
}

TEST(Reference, EveryKeyIsInBoth) {
  const std::string markdown = scene_reference_markdown();
  const auto schema = nlohmann::json::parse(scene_json_schema());
  for (const Section& section : scene_sections()) {
    auto place = section.form == SectionForm::root ? schema : schema["properties"][section.name];
    if (section.form == SectionForm::named) place = place["additionalProperties"];
    if (section.form == SectionForm::list) place = place["items"];
    EXPECT_FALSE(place["additionalProperties"].get<bool>());
    for (const Key& key : section.keys) {
      EXPECT_THAT(markdown, HasSubstr("\n| `" + key.name + "` | "));
      EXPECT_TRUE(place["properties"].contains(key.name)) << section.name << '.' << key.name;
    }
  }
}

// What tables of declarations are held to.
TEST(Declaration, IsConsistent) {
  std::set<std::string> sections;
  for (const Section& section : scene_sections()) {
    EXPECT_TRUE(sections.insert(section.name).second) << section.name;
    EXPECT_FALSE(section.doc.empty()) << section.name;
    std::set<std::string> keys;
    for (const Key& key : section.keys) {
      const std::string name = section.name + '.' + key.name;
      EXPECT_TRUE(keys.insert(key.name).second) << name;
      EXPECT_EQ(key.doc.back(), '.') << name;
      EXPECT_EQ(key.doc.find('\n'), std::string::npos) << name;
      EXPECT_EQ(key.doc.find('|'), std::string::npos) << name;
      EXPECT_EQ(key.kind == Kind::choice, !key.names.empty()) << name;
      EXPECT_FALSE(key.required && !key.fallback.empty()) << name;
      EXPECT_LT(key.range.min, key.range.max) << name;
      if (!key.fallback.empty()) {
        const Expected<Node> node = parse_document("value = " + key.fallback, "default");
        ASSERT_TRUE(node) << name;
        EXPECT_TRUE(value_of(key, node->as<Table>()->front().node, name)) << name;
      }
    }
    for (const std::string& key : section.exactly_one) EXPECT_TRUE(keys.contains(key)) << section.name << '.' << key;
  }
}

TEST(Declaration, RangesInWords) {
  EXPECT_EQ(text_of(at_least(0.0)), "at least 0");
  EXPECT_EQ(text_of(Range{.min = 0.0, .min_open = true}), "more than 0");
  EXPECT_EQ(text_of(within(1, 100)), "1 to 100");
  EXPECT_EQ(text_of(within(-4000000, 1e15)), "-4000000 to 1e15");
  EXPECT_EQ(text_of(strictly_within(-1.0, 0.5)), "more than -1 and less than 0.5");
  EXPECT_EQ(text_of(Range{.max = 3.0}), "at most 3");
  EXPECT_EQ(text_of(Range{}), "");
}

}  // namespace
}  // namespace rhexis::scene::test
