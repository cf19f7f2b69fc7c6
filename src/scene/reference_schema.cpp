#include <cmath>

#include <nlohmann/json.hpp>

#include "base/check.h"
#include "scene/declaration.h"
#include "scene/document.h"
#include "scene/reference.h"

namespace rhexis::scene {
namespace {

using Json = nlohmann::ordered_json;

Json number_schema(const Range& range, const char* type = "number") {
  Json schema{{"type", type}};
  // Whole numbers without a decimal point, as an editor shows them.
  const auto bound = [](double value) {
    return value == static_cast<double>(static_cast<std::int64_t>(value)) ? Json(static_cast<std::int64_t>(value))
                                                                          : Json(value);
  };
  if (!std::isinf(range.min)) schema[range.min_open ? "exclusiveMinimum" : "minimum"] = bound(range.min);
  if (!std::isinf(range.max)) schema[range.max_open ? "exclusiveMaximum" : "maximum"] = bound(range.max);
  return schema;
}

Json vector_schema(const Range& range) {
  return {{"type", "array"}, {"items", number_schema(range)}, {"minItems", 3}, {"maxItems", 3}};
}

Json object_schema(Json properties, const std::vector<std::string>& required) {
  Json schema{{"type", "object"}, {"properties", std::move(properties)}, {"additionalProperties", false}};
  if (!required.empty()) schema["required"] = required;
  return schema;
}

Json value_schema(const Key& key) {
  switch (key.kind) {
    case Kind::boolean: return {{"type", "boolean"}};
    case Kind::integer: return number_schema(key.range, "integer");
    case Kind::number: return number_schema(key.range);
    case Kind::text: return {{"type", "string"}};
    case Kind::file:
    case Kind::set: return {{"type", "string"}, {"minLength", 1}};
    case Kind::choice: return {{"type", "string"}, {"enum", key.names}};
    case Kind::vector: return vector_schema(key.range);
    case Kind::indices: return {{"type", "array"}, {"items", number_schema(key.range, "integer")}};
    case Kind::numbers: return {{"type", "array"}, {"items", number_schema(key.range)}, {"minItems", 1}};
    case Kind::number_or_auto: return {{"anyOf", {number_schema(key.range), {{"type", "string"}, {"enum", {"auto"}}}}}};
    case Kind::length:
      return {
          {"anyOf",
           {number_schema(key.range), {{"type", "string"}, {"pattern", "^ *[+-]?[0-9.]+([eE][+-]?[0-9]+)? *% *$"}}}}};
    case Kind::box:
      return object_schema({{"from", vector_schema(key.range)}, {"to", vector_schema(key.range)}}, {"from", "to"});
  }
  return {};
}

Json json_of(const Node& node) {
  if (const auto* boolean = node.as<bool>()) return *boolean;
  if (const auto* integer = node.as<std::int64_t>()) return *integer;
  if (const auto* number = node.as<double>()) return *number;
  if (const auto* text = node.as<std::string>()) return *text;
  Json array = Json::array();
  if (const auto* items = node.as<Array>())
    for (const Node& item : *items) array.push_back(json_of(item));
  return array;
}

Json key_schema(const Key& key) {
  Json schema = value_schema(key);
  schema["description"] = key.unit.empty() || key.kind == Kind::length ? key.doc : key.doc + " [" + key.unit + ']';
  if (!key.fallback.empty()) {
    const Expected<Node> parsed = parse_document("value = " + key.fallback, "the default");
    RHEXIS_CHECK(parsed, "default of '{}'", key.name);
    schema["default"] = json_of(parsed->as<Table>()->front().node);
  }
  return schema;
}

Json section_schema(const Section& section) {
  Json properties = Json::object();
  std::vector<std::string> required;
  for (const Key& key : section.keys) {
    properties[key.name] = key_schema(key);
    if (key.required) required.push_back(key.name);
  }
  Json schema = object_schema(std::move(properties), required);
  if (!section.exactly_one.empty()) {
    schema["oneOf"] = Json::array();
    for (const std::string& key : section.exactly_one) schema["oneOf"].push_back({{"required", Json::array({key})}});
  }
  return schema;
}

}  // namespace

std::string scene_json_schema() {
  const Section& root = scene_sections().front();
  Json schema = section_schema(root);
  std::vector<std::string> required;
  for (const Section& section : scene_sections().subspan(1)) {
    Json& place = schema["properties"][section.name];
    if (section.form == SectionForm::single) place = section_schema(section);
    if (section.form == SectionForm::named)
      place = {{"type", "object"}, {"additionalProperties", section_schema(section)}};
    if (section.form == SectionForm::list) place = {{"type", "array"}, {"items", section_schema(section)}};
    place["description"] = section.doc;
    if (section.required) required.push_back(section.name);
  }
  schema["required"] = required;
  Json head{{"$schema", "http://json-schema.org/draft-07/schema#"}, {"title", "Rhexis scene"}};
  head.update(schema);
  return head.dump(2) + '\n';
}

}  // namespace rhexis::scene
