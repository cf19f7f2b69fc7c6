#include "session/recording_head.h"

#include <limits>

#include <nlohmann/json.hpp>

namespace rhexis::session {
namespace {

using Json = nlohmann::ordered_json;

/// All numbers of the tick's settings under their names. Shortest decimals that read back to the same bits; JSON has no
/// infinity, which is null.
template <class Settings, class Use>
void each_number(Settings& tick, Use&& use) {
  use("stiffness", tick.stiffness);
  use("damping", tick.damping);
  use("velocity_cutoff", tick.velocity_cutoff);
  use("motion_scale", tick.motion_scale);
  use("force_scale", tick.force_scale);
  use("max_force", tick.max_force);
  use("ramp_ticks", tick.ramp_ticks);
  use("late_ticks", tick.late_ticks);
  use("lost_ticks", tick.lost_ticks);
  use("restrains", tick.restrains);
  use("most_restraint", tick.most_restraint);
  use("reserve", tick.reserve);
}

bool read(const Json& value, double& out) {
  if (value.is_null()) out = std::numeric_limits<double>::infinity();
  if (value.is_number()) out = value.get<double>();
  return value.is_null() || value.is_number();
}

bool read(const Json& value, int& out) {
  if (!value.is_number_integer()) return false;
  const auto number = value.get<std::int64_t>();
  out = static_cast<int>(number);
  return number == out;
}

bool read(const Json& value, bool& out) {
  if (value.is_boolean()) out = value.get<bool>();
  return value.is_boolean();
}

bool read(const Json& value, std::string& out) {
  if (value.is_string()) out = value.get<std::string>();
  return value.is_string();
}

}  // namespace

haptics::DeviceTraits RecordingHead::traits() const {
  haptics::DeviceTraits out;
  out.name = device;
  out.max_force = device_max_force;
  out.resolution = device_resolution;
  out.delay = device_delay;
  out.counts_from_hold = counts_from_hold;
  return out;
}

std::string text_of(const RecordingHead& head) {
  Json json{{"version", head.version},
            {"device", head.device},
            {"device_max_force", head.device_max_force},
            {"device_resolution", head.device_resolution},
            {"device_delay", head.device_delay},
            {"counts_from_hold", head.counts_from_hold}};
  Json tick = Json::object();
  each_number(head.tick, [&](const char* name, const auto& value) { tick[name] = value; });
  json["tick"] = std::move(tick);
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Expected<RecordingHead> parse_recording_head(const std::string& text) {
  const Json json = Json::parse(text, nullptr, /*allow_exceptions=*/false);
  const auto missing = [](const char* name) { return fail(fmt::format("its settings have no good '{}'", name)); };
  if (!json.is_object()) return fail("its settings are not JSON");
  const auto has = [](const Json& in, const char* name, auto& out) { return in.contains(name) && read(in[name], out); };
  RecordingHead head;
  if (!has(json, "version", head.version)) return missing("version");
  if (!has(json, "device", head.device)) return missing("device");
  if (!has(json, "device_max_force", head.device_max_force)) return missing("device_max_force");
  if (!has(json, "device_resolution", head.device_resolution)) return missing("device_resolution");
  if (!has(json, "device_delay", head.device_delay)) return missing("device_delay");
  if (!has(json, "counts_from_hold", head.counts_from_hold)) return missing("counts_from_hold");
  if (!json.contains("tick") || !json["tick"].is_object()) return missing("tick");
  const char* bad = nullptr;
  each_number(head.tick, [&](const char* name, auto& value) {
    if (!has(json["tick"], name, value)) bad = name;
  });
  if (bad != nullptr) return missing(bad);
  if (const Expected<void> good = haptics::check_settings(head.tick); !good) return fail(good.error());
  return head;
}

}  // namespace rhexis::session
