#pragma once

/// A scene that has met its mesh: all that the solver needs.

#include <memory>
#include <string>
#include <vector>

#include "base/error.h"
#include "mesh/tet_mesh.h"
#include "model/loading.h"
#include "model/make_model.h"
#include "scene/scene.h"
#include "solver/options.h"

namespace rhexis::scene {

struct Problem {
  std::string title;              ///< of the scene; its file's name where it has none
  mesh::TetMesh mesh;             ///< with the scene's sets
  model::ModelSettings settings;  ///< what `model` was made from; beta is a number now
  std::unique_ptr<model::Model> model;
  model::Loading loading;  ///< nodes that no tet has are held in all components
  solver::Options options;
  std::vector<std::string> warnings;  ///< one line each
  std::vector<std::string> notes;     ///< one line each
};

/// Reads or generates the mesh and holds the scene against it. The number of threads is the caller's to set
/// (scene.solver.threads).
[[nodiscard]] Expected<Problem> build_problem(const Scene& scene);

}  // namespace rhexis::scene
