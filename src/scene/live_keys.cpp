#include "scene/live_keys.h"

#include <cmath>
#include <functional>

#include <nlohmann/json.hpp>

#include "scene/values.h"

namespace rhexis::scene {
namespace {

using Json = nlohmann::ordered_json;

const char* kind_name(Kind kind) {
  switch (kind) {
    case Kind::boolean: return "boolean";
    case Kind::integer: return "integer";
    case Kind::number: return "number";
    case Kind::choice: return "choice";
    default: return nullptr;  // what a panel has no field for
  }
}

/// What a body that is held is made of. The shape, the supports and the loads are the scene's own.
bool is_live(const Section& section, const Key& key) {
  if (kind_name(key.kind) == nullptr) return false;
  if (section.name == "mesh") return key.name == "nodes";
  if (section.name == "model") return key.name == "kind";
  if (section.name == "interaction") return key.name != "response";
  return section.name == "material" || section.name == "fracture";
}

void for_each_live_key(const std::function<void(const Section&, const Key&)>& use) {
  for (const Section& section : scene_sections()) {
    for (const Key& key : section.keys) {
      if (section.form == SectionForm::single && is_live(section, key)) use(section, key);
    }
  }
}

Json value_json(const Value& value) {
  if (const auto* boolean = std::get_if<bool>(&value)) return *boolean;
  if (const auto* integer = std::get_if<std::int64_t>(&value)) return *integer;
  if (const auto* number = std::get_if<double>(&value)) return *number;
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  return nullptr;
}

}  // namespace

std::string live_keys_json() {
  Json keys = Json::array();
  for_each_live_key([&](const Section& section, const Key& key) {
    Json entry{{"key", section.name + '.' + key.name}, {"kind", kind_name(key.kind)}};
    if (!key.unit.empty()) entry["unit"] = key.unit;
    if (!std::isinf(key.range.min)) entry["min"] = key.range.min;
    if (!std::isinf(key.range.max)) entry["max"] = key.range.max;
    if (!key.names.empty()) entry["choices"] = key.names;
    if (!key.otherwise.empty()) entry["otherwise"] = key.otherwise;
    entry["doc"] = key.doc;
    keys.push_back(std::move(entry));
  });
  return keys.dump();
}

Expected<std::string> live_values_json(const std::string& text, const std::string& file,
                                       const std::vector<std::string>& overrides) {
  const Expected<Values> values = parse_values(text, file, overrides);
  if (!values) return fail(values.error());
  Json out = Json::object();
  for_each_live_key([&](const Section& section, const Key& key) {
    const Setting* setting = values->one(section.name).find(key.name);
    out[section.name + '.' + key.name] = setting != nullptr ? value_json(setting->value) : Json(nullptr);
  });
  return out.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace rhexis::scene
