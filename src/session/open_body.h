#pragma once

/// A scene that has been opened to be held: its text, what was made of it, and its surface. What a reset makes anew.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "scene/tear_problem.h"
#include "session/start.h"
#include "session/surface_tracker.h"

namespace rhexis::session {

/// A mesh file as it was when its scene was read.
struct MeshBytes {
  std::filesystem::path file;
  std::string bytes;
};

/// What decides a body to the bit.
struct SceneChoice {
  std::string file;                                 ///< as it is named to clients
  std::string text;                                 ///< TOML
  std::vector<std::string> overrides;               ///< "key=value", in the order of --set
  std::shared_ptr<const MeshBytes> mesh = nullptr;  ///< that the scene reads; null: it generates its mesh
  std::uint64_t record = 0;  ///< fingerprint of the record that its response needs; 0: none, or not known yet
};

struct OpenBody {
  SceneChoice scene;
  scene::TearProblem problem;
  TearStart start;
  SurfaceTracker surface;
  std::size_t first_topology = 0;         ///< number of edits that the scene's own cracks made
  std::vector<double> advance_time = {};  ///< s, of the haptic clock, per advance of the session
  /// Of the mesh at first, then chained with every edit made or taken back.
  std::uint64_t fingerprint = 0;

  [[nodiscard]] TearSession& tear() const { return *start.tear; }
};

/// Reads a scene's file, and the mesh file that it names. Errors: of the two files. That the scene is no good,
/// open_body says.
[[nodiscard]] Expected<SceneChoice> read_scene_choice(std::string file, std::vector<std::string> overrides);
/// Reads no file but the record that the response needs, which is held against `scene.record`. Errors are those of the
/// scene, its mesh, its record and its first cracks; a scene that names another mesh file than `scene` holds.
[[nodiscard]] Expected<std::unique_ptr<OpenBody>> open_body(SceneChoice scene);
/// The same body from the start again, without reading anything.
[[nodiscard]] Expected<std::unique_ptr<OpenBody>> reopen(const OpenBody& body);

/// The fingerprint after an edit that the body took, or gave back.
[[nodiscard]] std::uint64_t chained(std::uint64_t fingerprint, const mesh::MeshEdit& edit, bool taken_back);

}  // namespace rhexis::session
