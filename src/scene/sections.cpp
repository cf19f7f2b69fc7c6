#include "scene/sections.h"

#include <algorithm>
#include <functional>
#include <optional>

#include <Eigen/Geometry>

#include "scene/units.h"

namespace rhexis::scene {
namespace {
namespace fs = std::filesystem;

std::optional<double> optional_number(const SectionValues& values, std::string_view key) {
  const Setting* setting = values.find(key);
  return setting == nullptr ? std::nullopt : std::optional<double>(std::get<double>(setting->value));
}

Expected<GeneratedBox> read_box_shape(const SectionValues& values, const std::string& kind, Scene& scene) {
  const std::string by = "generate = \"" + kind + '"';
  for (const std::string_view key : {"radius", "length", "wall", "bend"}) warn_unread(values, key, by, scene);
  if (!values.given_key("size")) return missing(values, "size", ", which " + by + " needs");
  GeneratedBox box{.plate = kind == "plate", .shape = {values.get<Vec3>("size")}, .nodes = 0};
  const Vec3& size = box.shape.size;
  if (kind == "cube" && (size.array() != size[0]).any())
    return values.place_of("size").fail("the edges of the cube differ",
                                        "three times the same length, or generate = \"bar\"");
  if (kind == "plate" && size[2] > std::min(size[0], size[1]))
    return values.place_of("size").fail("the plate is thicker than wide", "its thickness is the third number, along z");
  return box;
}

Expected<GeneratedTube> read_tube_shape(const SectionValues& values) {
  GeneratedTube tube;
  if (values.given_key("size")) {
    for (const std::string_view key : {"radius", "length"})
      if (values.given_key(key))
        return values.place_of(key).fail(
            fmt::format("{} and {} are both given", in_quotes(values.path_of("size")), in_quotes(values.path_of(key))),
            "a tube takes radius and length, or size = [2 radius, 2 radius, length]");
    const Vec3& size = values.get<Vec3>("size");
    if (size[0] != size[1])
      return values.place_of("size").fail("the tube is not round", "size = [2 radius, 2 radius, length]");
    tube.shape.radius = 0.5 * size[0];
    tube.shape.length = size[2];
  } else {
    for (const std::string_view key : {"radius", "length"})
      if (!values.given_key(key)) return missing(values, key, ", which generate = \"tube\" needs");
    tube.shape.radius = values.get<double>("radius");
    tube.shape.length = values.get<double>("length");
  }
  tube.shape.wall = values.get<double>("wall");
  tube.shape.bend = values.get<double>("bend");
  if (tube.shape.wall >= tube.shape.radius)
    return values.place_of("wall").fail(
        fmt::format("the wall is {} m thick", tube.shape.wall),
        fmt::format("less than the radius, {} m; 0 for a solid rod", tube.shape.radius));
  return tube;
}

}  // namespace

tl::unexpected<Error> missing(const SectionValues& values, std::string_view key, const std::string& why) {
  return values.place.fail(in_quotes(values.path_of(key)) + " is missing" + why,
                           "give " + wanted(*values.section->find(key)));
}

void warn_unread(const SectionValues& values, std::string_view key, const std::string& by, Scene& scene) {
  if (!values.given_key(key)) return;
  scene.warnings.push_back(
      values.place_of(key).fail(in_quotes(values.path_of(key)) + " is not read by " + by).value().message());
}

Side side_named(const std::string& name) {
  RHEXIS_CHECK(name.size() == 2, "side '{}'", name);
  return {name[1] - 'x', name[0] == '+', name};
}

Expected<MeshSettings> read_mesh_section(const SectionValues& values, const fs::path& folder, Scene& scene) {
  if (values.given_key("file")) {
    for (const std::string_view key : {"size", "nodes", "radius", "length", "wall", "bend"})
      warn_unread(values, key, "a mesh from a file", scene);
    return MeshSettings{
        MeshFromFile{folder / values.get<std::string>("file"), metres_per(values.get<std::string>("unit"))},
        values.place_of("file")};
  }
  const std::string& kind = values.get<std::string>("generate");
  warn_unread(values, "unit", "a generated mesh, which is in metres", scene);
  if (!values.given_key("nodes")) return missing(values, "nodes", ", which generate = \"" + kind + "\" needs");
  const int nodes = static_cast<int>(values.get<std::int64_t>("nodes"));
  MeshSettings settings{{}, values.place_of("generate")};
  if (kind == "tube") {
    Expected<GeneratedTube> tube = read_tube_shape(values);
    if (!tube) return fail(std::move(tube.error()));
    tube->nodes = nodes;
    settings.source = *tube;
  } else {
    Expected<GeneratedBox> box = read_box_shape(values, kind, scene);
    if (!box) return fail(std::move(box.error()));
    box->nodes = nodes;
    settings.source = *box;
  }
  return settings;
}

ModelChoice read_model_section(const SectionValues& values, Scene& scene) {
  ModelChoice choice;
  const std::string& kind = values.get<std::string>("kind");
  choice.kind = model::kind_named(kind);
  choice.kind_place = values.place_of("kind");
  if (const auto* beta = std::get_if<double>(&values.find("beta")->value)) choice.beta = *beta;
  choice.initial_lambda = values.get<double>("initial_lambda");
  if (values.get<std::string>("corotated_tangent") == "warped")
    choice.corotated_tangent = model::CorotatedTangent::warped;

  const bool stabilised = choice.kind == model::ModelKind::hyperelastic;
  if (!stabilised) warn_unread(values, "beta", in_quotes(kind), scene);
  if (!model::is_mixed(choice.kind)) warn_unread(values, "initial_lambda", in_quotes(kind), scene);
  if (choice.kind != model::ModelKind::corotated) warn_unread(values, "corotated_tangent", in_quotes(kind), scene);
  return choice;
}

Expected<SupportSettings> read_support(const SectionValues& values) {
  SupportSettings support;
  support.set = values.get<std::string>("set");
  support.place = values.place;
  support.set_place = values.place_of("set");
  bool fixes_any = false;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::string_view key = std::string_view("xyz").substr(axis, 1);
    if (!values.given_key(key)) continue;
    fixes_any = true;
    support.displacement[axis] = values.get<Length>(key);
    support.displacement_place[axis] = values.place_of(key);
  }
  if (!fixes_any) return values.place.fail(in_quotes(values.path) + " fixes nothing", "give x, y or z");
  return support;
}

Expected<FractureSettings> read_fracture_section(const SectionValues& values, Scene& scene) {
  FractureSettings fracture;
  if (const Setting* criterion = values.find("criterion")) fracture.criterion = std::get<std::string>(criterion->value);
  fracture.strength = optional_number(values, "strength");
  fracture.toughness = optional_number(values, "toughness");
  fracture.advance_threshold = optional_number(values, "advance_threshold");
  fracture.ahead_only = values.get<bool>("ahead_only");
  fracture.local_radius = optional_number(values, "local_radius");
  fracture.incision = values.get<std::string>("incision");
  fracture.place = values.place;
  if (fracture.toughness) warn_unread(values, "advance_threshold", "a toughness", scene);
  if (fracture.strength && !fracture.advance_threshold) fracture.advance_threshold = 0.5 * *fracture.strength;
  if (fracture.strength && *fracture.advance_threshold > *fracture.strength)
    return values.place_of("advance_threshold")
        .fail(fmt::format("'fracture.advance_threshold' is {}", *fracture.advance_threshold),
              fmt::format("at most the strength, {} Pa", *fracture.strength));
  return fracture;
}

Expected<CrackSettings> read_crack(const SectionValues& values) {
  const fracture::CrackLine line{values.get<Vec3>("from"), values.get<Vec3>("to"), values.get<Vec3>("through")};
  const Vec3 along = line.to - line.from;
  if (along.norm() == 0.0) return values.place_of("to").fail("the crack has no length", "'to' away from 'from'");
  // Below this sine the plane that the two directions span is rounding.
  constexpr double kParallel = 1e-6;
  if (!(along.normalized().cross(line.through.normalized()).norm() > kParallel))
    return values.place_of("through").fail("'through' does not span a plane with the crack",
                                           "a direction across 'to' - 'from'");
  return CrackSettings{line, values.place};
}

Expected<RecordSettings> read_record_section(const SectionValues& values) {
  const auto integer = [&](std::string_view key) { return static_cast<int>(values.get<std::int64_t>(key)); };
  RecordSettings record;
  record.parameters = {.advances = integer("advances"),
                       .directions = integer("directions"),
                       .lengths = values.get<std::vector<double>>("lengths"),
                       .pull_directions = integer("pull_directions"),
                       .pull_length = values.get<double>("pull_length")};
  record.single_precision = values.get<std::string>("precision") == "single";
  const std::vector<double>& lengths = record.parameters.lengths;
  if (lengths.empty()) return values.place_of("lengths").fail("'record.lengths' is empty", "one length at least");
  if (std::adjacent_find(lengths.begin(), lengths.end(), std::greater_equal<>()) != lengths.end())
    return values.place_of("lengths").fail("'record.lengths' do not ascend", "each longer than the one before");
  return record;
}

Expected<InteractionSettings> read_interaction_section(const SectionValues& values, const fs::path& folder) {
  InteractionSettings interaction;
  interaction.response = values.get<std::string>("response");
  interaction.max_force = values.get<double>("max_force");
  interaction.blend_contact = values.get<std::string>("contact") == "blend";
  if (values.given) interaction.place = values.place;
  if (const Setting* record = values.find("record")) interaction.record = folder / std::get<std::string>(record->value);
  if (interaction.response == "recorded" && !interaction.record)
    return missing(values, "record", ", which response = \"recorded\" needs");
  return interaction;
}

}  // namespace rhexis::scene
