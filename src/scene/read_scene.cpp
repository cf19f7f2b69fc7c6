#include <array>
#include <fstream>
#include <sstream>

#include "scene/overrides.h"
#include "scene/scene.h"
#include "scene/sections.h"

namespace rhexis::scene {
namespace {
namespace fs = std::filesystem;

SetSettings read_set(const SectionValues& values) {
  SetSettings set;
  set.name = values.name;
  for (const std::string_view key : {"side", "box", "nearest", "nodes"}) {
    if (!values.given_key(key)) continue;
    set.place = values.place_of(key);
    if (key == "side") set.choice = side_named(values.get<std::string>(key));
    if (key == "box") set.choice = values.get<Box>(key);
    if (key == "nearest") set.choice = values.get<Vec3>(key);
    if (key == "nodes") set.choice = values.get<std::vector<std::int64_t>>(key);
  }
  return set;
}

FaceChoice read_faces(const SectionValues& values) {
  if (values.given_key("set")) return {values.get<std::string>("set"), values.place_of("set")};
  return {side_named(values.get<std::string>("side")), values.place_of("side")};
}

SolverSettings read_solver(const SectionValues& values) {
  const auto integer = [&](std::string_view key) { return static_cast<int>(values.get<std::int64_t>(key)); };
  SolverSettings settings;
  settings.options.linear = values.get<std::string>("linear");
  settings.options.tolerance = values.get<double>("tolerance");
  settings.options.steps = integer("steps");
  settings.options.max_iterations = integer("max_iterations");
  settings.options.max_cuts = integer("max_cuts");
  settings.threads = integer("threads");
  return settings;
}

DynamicsSettings read_dynamics(const SectionValues& values) {
  return {.step = values.get<double>("step"),
          .mass_damping = values.get<double>("mass_damping"),
          .stiffness_damping = values.get<double>("stiffness_damping"),
          .place = values.place};
}

PullSettings read_pull(const SectionValues& values) {
  return {values.get<Vec3>("at"),
          values.get<Vec3>("by"),
          values.get<double>("seconds"),
          values.get<double>("hold"),
          values.get<double>("wait"),
          values.get<std::string>("mode") == "push",
          values.place};
}

/// Appends read(entry) of every entry; the first error ends it.
template <class Settings, class Read>
Expected<void> read_list(const std::vector<SectionValues>& entries, std::vector<Settings>& out, const Read& read) {
  for (const SectionValues& entry : entries) {
    Expected<Settings> settings = read(entry);
    if (!settings) return fail(std::move(settings.error()));
    out.push_back(std::move(*settings));
  }
  return {};
}

template <class Settings>
Expected<void> take(Expected<Settings> read, Settings& out) {
  if (!read) return fail(std::move(read.error()));
  out = std::move(*read);
  return {};
}

Expected<Scene> settings_of(const Values& values, const std::string& file) {
  const fs::path folder = fs::path(file).parent_path();
  Scene scene;
  scene.file = file;
  scene.title = values.one("").get<std::string>("title");
  scene.gravity = values.one("").get<Vec3>("gravity");
  scene.model = read_model_section(values.one("model"), scene);
  scene.solver = read_solver(values.one("solver"));
  if (values.one("dynamics").given) scene.dynamics = read_dynamics(values.one("dynamics"));
  for (const SectionValues& set : values.all("sets")) scene.sets.push_back(read_set(set));
  for (const SectionValues& entry : values.all("traction"))
    scene.tractions.push_back({read_faces(entry), entry.get<Vec3>("force")});
  for (const SectionValues& entry : values.all("pressure"))
    scene.pressures.push_back({read_faces(entry), entry.get<double>("value")});
  for (const SectionValues& entry : values.all("pull")) scene.pulls.push_back(read_pull(entry));

  const std::array<Expected<void>, 6> read{
      take(read_mesh_section(values.one("mesh"), folder, scene), scene.mesh),
      take(read_material_section(values.one("material"), scene), scene.material),
      read_list(values.all("support"), scene.supports, read_support),
      read_list(values.all("crack"), scene.cracks, read_crack),
      take(read_record_section(values.one("record")), scene.record),
      take(read_interaction_section(values.one("interaction"), folder), scene.interaction),
  };
  for (const Expected<void>& part : read)
    if (!part) return fail(part.error());
  if (values.one("fracture").given) {
    Expected<FractureSettings> fracture = read_fracture_section(values.one("fracture"), scene);
    if (!fracture) return fail(std::move(fracture.error()));
    scene.fracture = std::move(*fracture);
  }
  return scene;
}

}  // namespace

Expected<Values> parse_values(std::string_view text, const std::string& file,
                              const std::vector<std::string>& overrides) {
  Expected<Node> root = parse_document(text, file);
  if (!root) return fail(std::move(root.error()));
  for (const std::string& override : overrides)
    if (Expected<void> applied = apply_override(*root, override); !applied) return fail(std::move(applied.error()));
  return validate(*root);
}

Expected<Scene> parse_scene(std::string_view text, const std::string& file, const std::vector<std::string>& overrides) {
  const Expected<Values> values = parse_values(text, file, overrides);
  if (!values) return fail(values.error());
  return settings_of(*values, file);
}

std::string title_of(const Scene& scene) {
  return scene.title.empty() ? fs::path(scene.file).stem().string() : scene.title;
}

Expected<std::string> read_scene_text(const fs::path& path) {
  const std::string name = path.string();
  std::error_code code;
  const fs::file_status status = fs::status(path, code);
  if (!fs::exists(status)) return fail("there is no such file", "a scene, as in scenes/bar.toml", name);
  if (!fs::is_regular_file(status)) return fail("not a file", "a scene, as in scenes/bar.toml", name);
  const std::uintmax_t bytes = fs::file_size(path, code);
  if (!code && bytes > kMaxSceneBytes)
    return fail(fmt::format("the scene has {} bytes", bytes), fmt::format("at most {}", kMaxSceneBytes), name);
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  if (!stream.is_open() || stream.bad()) return fail("cannot be read", "check its permissions", name);
  return text.str();
}

Expected<Scene> read_scene(const fs::path& path, const std::vector<std::string>& overrides) {
  const Expected<std::string> text = read_scene_text(path);
  if (!text) return fail(text.error());
  return parse_scene(*text, path.string(), overrides);
}

}  // namespace rhexis::scene
