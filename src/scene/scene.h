#pragma once

/// A scene as its file says it: typed, in SI units, defaults filled in, every value within its declared range. Nothing
/// of it has met a mesh yet: that is scene/problem.h.

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "base/error.h"
#include "base/vec.h"
#include "fracture/path_start.h"
#include "material/parameters.h"
#include "mesh/generate.h"
#include "model/make_model.h"
#include "record/store/parameters.h"
#include "scene/document.h"
#include "scene/values.h"
#include "solver/options.h"

namespace rhexis::scene {

struct MeshFromFile {
  std::filesystem::path path;                          ///< found from here, not from the scene
  double unit = 1.0;                                   ///< metres per unit of the file
  std::shared_ptr<const std::string> bytes = nullptr;  ///< the file's, where they are at hand; null: it is read
};
struct GeneratedBox {
  bool plate = false;  ///< thin in z; else a bar or cube
  mesh::BoxShape shape;
  int nodes = 0;
};
struct GeneratedTube {
  mesh::TubeShape shape;
  int nodes = 0;
};
struct MeshSettings {
  std::variant<MeshFromFile, GeneratedBox, GeneratedTube> source;
  Place place;  ///< of `file` or `generate`
};

/// A side of the bounding box.
struct Side {
  int axis = 0;        ///< 0 x, 1 y, 2 z
  bool upper = false;  ///< "+x"
  std::string name;    ///< "+x"
};
[[nodiscard]] Side side_named(const std::string& name);

struct SetSettings {
  std::string name;
  std::variant<Side, Box, Vec3, std::vector<std::int64_t>> choice;  ///< Vec3: the nearest node
  Place place;                                                      ///< of the choice
};

/// Both forms; the one that was not given is converted (section 1.2 of the specification), with a note where it is
/// read.
struct MaterialSettings {
  double density = 0.0;  ///< kg/m3
  material::Elastic elastic;
  material::MooneyRivlin law;
};

struct ModelChoice {
  model::ModelKind kind = model::ModelKind::hyperelastic;
  Place kind_place;
  std::optional<double> beta;   ///< empty: "auto"
  double initial_lambda = 0.0;  ///< Pa
  model::CorotatedTangent corotated_tangent = model::CorotatedTangent::exact;
};

struct SupportSettings {
  std::string set;
  std::array<std::optional<Length>, 3> displacement;  ///< x, y, z; empty: free
  Place place;                                        ///< of the entry
  Place set_place;
  std::array<Place, 3> displacement_place;
};

/// Faces by the name of a set, or by a side.
struct FaceChoice {
  std::variant<std::string, Side> set;
  Place place;
};
struct TractionSettings {
  FaceChoice faces;
  Vec3 force = Vec3::Zero();  ///< N in all
};
struct PressureSettings {
  FaceChoice faces;
  double value = 0.0;  ///< Pa, > 0 pushes against the outward normal
};

struct SolverSettings {
  solver::Options options;
  int threads = 0;  ///< 0: all cores
};

struct DynamicsSettings {
  double step = 0.0;               ///< s
  double mass_damping = 0.0;       ///< 1/s
  double stiffness_damping = 0.0;  ///< s
  Place place;
};

struct FractureSettings {
  std::optional<std::string> criterion;     ///< empty: by the body
  std::optional<double> strength;           ///< Pa; this or toughness
  std::optional<double> toughness;          ///< N/m
  std::optional<double> advance_threshold;  ///< Pa; half of strength when that is given, not read with a toughness
  bool ahead_only = true;
  std::optional<double> local_radius;  ///< m; empty: four mean edge lengths
  std::string incision;                ///< "keep-nodes", "split"
  Place place;
};
struct CrackSettings {
  fracture::CrackLine line;
  Place place = {};
};
struct InteractionSettings {
  std::string response;                         ///< "exact", "recorded"
  std::optional<std::filesystem::path> record;  ///< found from here; always given with "recorded"
  double max_force = 0.0;                       ///< N
  bool blend_contact = false;                   ///< the thesis's rule for a point inside a triangle
  std::optional<Place> place;                   ///< empty: the section is left out
};
struct PullSettings {
  Vec3 at = Vec3::Zero();  ///< m
  Vec3 by = Vec3::Zero();  ///< m
  double seconds = 0.0;
  double hold = 0.0;  ///< s, before the hand lets go
  double wait = 0.0;  ///< s, after it
  bool push = false;  ///< only where the hand presses, without friction
  Place place;
};

struct RecordSettings {
  record::store::Parameters parameters;
  bool single_precision = false;  ///< of the global operators
};

struct Scene {
  std::string file;  ///< as the user named it
  std::string title;
  Vec3 gravity = Vec3::Zero();  ///< m/s2
  MeshSettings mesh;
  std::vector<SetSettings> sets;
  MaterialSettings material;
  ModelChoice model;
  std::vector<SupportSettings> supports;
  std::vector<TractionSettings> tractions;
  std::vector<PressureSettings> pressures;
  SolverSettings solver;
  std::optional<DynamicsSettings> dynamics;
  std::optional<FractureSettings> fracture;
  std::vector<CrackSettings> cracks;
  RecordSettings record;
  InteractionSettings interaction;
  std::vector<PullSettings> pulls;
  std::vector<std::string> warnings;  ///< one line each, placed: what was given and is not read
  std::vector<std::string> notes;     ///< one line each: what was converted
};

/// The scene's title; its file's name where it has none.
[[nodiscard]] std::string title_of(const Scene& scene);

/// The bytes of a scene's file. Errors: none, or too large.
[[nodiscard]] Expected<std::string> read_scene_text(const std::filesystem::path& path);
/// Reads and validates; `overrides` are the arguments of `--set`, applied in order. Errors name FILE:LINE, or the
/// override.
[[nodiscard]] Expected<Scene> read_scene(const std::filesystem::path& path,
                                         const std::vector<std::string>& overrides = {});
/// The same for a text in memory; `file` stands in the errors, and files are looked for beside it.
[[nodiscard]] Expected<Scene> parse_scene(std::string_view text, const std::string& file,
                                          const std::vector<std::string>& overrides = {});

}  // namespace rhexis::scene
