#include "studies/perception_settings.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/hash.h"
#include "scene/scene.h"
#include "scene/values.h"

namespace rhexis::studies {
namespace {

namespace fs = std::filesystem;
using scene::Kind;
using scene::Place;
using scene::Section;
using scene::SectionForm;
using scene::SectionValues;

/// Two points and three directions, as many as the thesis has; it does not say which. Both points lie beside the mouth
/// of the crack, on the half that is not held.
constexpr std::string_view kPoints[] = {"[0.10, 0.0, 0.005]", "[0.0, 0.0, 0.005]"};
constexpr std::string_view kDirections[] = {"[-1.0, 0.0, 0.0]", "[-1.0, -1.0, 0.0]", "[0.0, -1.0, 0.0]"};

std::vector<Section> sections() {
  const std::vector<std::string> rules(kRuleNames.begin(), kRuleNames.end());
  return {
      {.name = "",
       .form = SectionForm::root,
       .doc = "Keys before the first section.",
       .keys = {{.name = "title", .kind = Kind::text, .fallback = "\"Which crack angles a hand can tell apart\""},
                {.name = "scene", .kind = Kind::file, .otherwise = "the plate of the thesis"},
                {.name = "seed", .kind = Kind::integer, .range = scene::within(0, 1e15), .fallback = "1"},
                {.name = "repeats", .kind = Kind::integer, .range = scene::within(1, 100), .fallback = "2"},
                {.name = "interleaved", .kind = Kind::boolean, .fallback = "false"},
                {.name = "classes",
                 .kind = Kind::numbers,
                 .unit = "degrees",
                 .range = scene::strictly_within(0, 180),
                 .fallback = "[15.0, 30.0, 45.0, 60.0]"}}},
      {.name = "crack",
       .doc = "How the cracks of sample, A and B have run on.",
       .keys = {{.name = "sample", .unit = "degrees", .range = scene::strictly_within(0, 180), .fallback = "90.0"},
                {.name = "length", .unit = "m", .range = scene::within(1e-6, 1e3), .fallback = "0.0403"}}},
      {.name = "rule",
       .doc = "Which difference is shown next.",
       .keys = {{.name = "name", .kind = Kind::choice, .fallback = "\"halving\"", .names = rules},
                {.name = "start", .unit = "degrees", .range = scene::strictly_within(0, 180), .fallback = "45.0"},
                {.name = "margin", .unit = "degrees", .range = scene::within(0.01, 45), .fallback = "1.0"},
                {.name = "steps", .kind = Kind::integer, .range = scene::within(1, 1000), .fallback = "5"},
                {.name = "trials", .kind = Kind::integer, .range = scene::within(1, 1000), .fallback = "40"},
                {.name = "reversals", .kind = Kind::integer, .range = scene::within(3, 1000), .fallback = "8"}}},
      {.name = "point",
       .form = SectionForm::list,
       .doc = "Where the plate is held: the surface point nearest to `at`.",
       .keys =
           {{.name = "at", .kind = Kind::vector, .unit = "m", .range = scene::within(-1e6, 1e6), .required = true}}},
      {.name = "direction",
       .form = SectionForm::list,
       .doc = "Along which it is pulled.",
       .keys = {{.name = "along", .kind = Kind::vector, .range = scene::within(-1e6, 1e6), .required = true}}},
  };
}

/// The thesis's experiment is one of ours, written as a file.
std::string thesis_text() {
  std::string text;
  for (const std::string_view point : kPoints) text += fmt::format("[[point]]\nat = {}\n", point);
  for (const std::string_view direction : kDirections) text += fmt::format("[[direction]]\nalong = {}\n", direction);
  return text;
}

int integer(const SectionValues& values, std::string_view key) {
  return static_cast<int>(values.get<std::int64_t>(key));
}

Expected<void> read_rule(const SectionValues& values, PerceptionSettings& settings) {
  RuleSettings& rule = settings.rule;
  rule.name = values.get<std::string>("name");
  rule.start = values.get<double>("start");
  rule.least = values.get<double>("margin");
  rule.most = settings.sample - rule.least;
  rule.steps = integer(values, "steps");
  rule.trials = integer(values, "trials");
  rule.reversals = integer(values, "reversals");
  if (rule.least <= rule.start && rule.start <= rule.most) return {};
  return values.place_of("start").fail(
      fmt::format("'rule.start' is {}, and differences have to leave the crack between 0 and the sample's {} degrees",
                  rule.start, settings.sample),
      fmt::format("{} to {}", rule.least, rule.most));
}

Expected<void> read_classes(const SectionValues& values, PerceptionSettings& settings) {
  settings.classes = values.get<std::vector<double>>("classes");
  settings.classes.insert(settings.classes.begin(), 0.0);
  if (std::is_sorted(settings.classes.begin(), settings.classes.end(), std::less_equal<>())) return {};
  return values.place_of("classes").fail("'classes' do not ascend", "where each class after the first begins");
}

Expected<void> read_directions(const std::vector<SectionValues>& entries, PerceptionSettings& settings) {
  for (const SectionValues& entry : entries) {
    const Vec3 along = entry.get<Vec3>("along");
    const double length = along.norm();
    if (length <= 0.0) return entry.place_of("along").fail("'direction.along' is no direction", "not all noughts");
    settings.directions.push_back({along / length, entry.place_of("along")});
  }
  return {};
}

Expected<PerceptionSettings> settings_of(const scene::Values& values, const std::string& file) {
  const SectionValues& root = values.one("");
  PerceptionSettings settings;
  settings.title = root.get<std::string>("title");
  if (root.given_key("scene")) settings.scene = fs::path(file).parent_path() / root.get<std::string>("scene");
  settings.seed = static_cast<std::uint64_t>(root.get<std::int64_t>("seed"));
  settings.repeats = integer(root, "repeats");
  settings.interleaved = root.get<bool>("interleaved");
  settings.sample = values.one("crack").get<double>("sample");
  settings.length = values.one("crack").get<double>("length");
  for (const SectionValues& entry : values.all("point"))
    settings.points.push_back({entry.get<Vec3>("at"), entry.place_of("at")});
  if (Expected<void> read = read_classes(root, settings); !read) return fail(std::move(read.error()));
  if (Expected<void> read = read_rule(values.one("rule"), settings); !read) return fail(std::move(read.error()));
  if (Expected<void> read = read_directions(values.all("direction"), settings); !read)
    return fail(std::move(read.error()));
  return settings;
}

Expected<scene::Values> values_of(std::string_view text, const std::string& file) {
  const Expected<scene::Node> root = scene::parse_document(text, file);
  if (!root) return fail(root.error());
  return scene::validate(*root, perception_sections());
}

}  // namespace

std::span<const Section> perception_sections() {
  static const std::vector<Section> kSections = sections();
  return kSections;
}

Expected<PerceptionSettings> parse_perception(std::string_view text, const std::string& file) {
  const Expected<scene::Values> values = values_of(text, file);
  if (!values) return fail(values.error());
  Expected<PerceptionSettings> settings = settings_of(*values, file);
  if (!settings || (!settings->points.empty() && !settings->directions.empty())) return settings;
  if (!settings->scene.empty())
    return fail(
        settings->points.empty() ? "nothing says where the plate is held" : "nothing says which way it is pulled",
        settings->points.empty() ? "add a [[point]]" : "add a [[direction]]", file);
  const Expected<scene::Values> thesis = values_of(thesis_text(), "the thesis's experiment");
  RHEXIS_CHECK(thesis.has_value(), "{}", thesis.error().message());
  const Expected<PerceptionSettings> own = settings_of(*thesis, file);
  RHEXIS_CHECK(own.has_value(), "{}", own.error().message());
  if (settings->points.empty()) settings->points = own->points;
  if (settings->directions.empty()) settings->directions = own->directions;
  return settings;
}

Expected<PerceptionSettings> read_perception(const fs::path& path) {
  if (path.empty()) return parse_perception({}, "the thesis's experiment");
  const Expected<std::string> text = scene::read_scene_text(path);
  if (!text)
    return fail(text.error().what, "an experiment, as in scenes/experiments/angle-perception.toml", path.string());
  return parse_perception(*text, path.string());
}

std::uint64_t fingerprint_of(const PerceptionSettings& settings) {
  std::string all = fmt::format("{} {} {} {} {}|{} {} {} {} {} {} {}", settings.scene.filename().string(),
                                settings.repeats, settings.interleaved, settings.sample, settings.length,
                                settings.rule.name, settings.rule.start, settings.rule.least, settings.rule.most,
                                settings.rule.steps, settings.rule.trials, settings.rule.reversals);
  for (const std::vector<PlacedVector>* vectors : {&settings.points, &settings.directions})
    for (const PlacedVector& v : *vectors) all += fmt::format("|{} {} {}", v.value.x(), v.value.y(), v.value.z());
  if (!settings.scene.empty())
    if (const Expected<std::string> text = scene::read_scene_text(settings.scene)) all += *text;
  return Hash().add(std::span<const char>(all)).value();
}

}  // namespace rhexis::studies
