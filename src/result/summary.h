#pragma once

/// summary.json: what a run was, how it ended and what it cost. The keys are fixed (docs/results.md).

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "mesh/tet_mesh.h"
#include "model/loading.h"
#include "model/model.h"
#include "result/fields.h"
#include "solver/equilibrium.h"

namespace rhexis::result {

/// Wall times of a run, s.
struct RunTimes {
  double read = 0.0;  ///< scene and mesh, patterns and batches
  double total = 0.0;
};

struct RunDescription {
  std::string title;
  std::string scene;               ///< as the user named it
  std::string model;               ///< its name in the scene
  std::string linear;              ///< the linear solver's name
  double beta = 0.0;               ///< hyperelastic: as used, after "auto"; else 0
  std::vector<std::string> notes;  ///< conversions, repairs
  std::vector<std::string> warnings;
};

/// Unknowns that are solved for: free displacements and pressures.
[[nodiscard]] std::size_t unknown_count(const model::Model& model, const model::Loading& loading);

/// A number that is not finite becomes null: JSON has no NaN.
[[nodiscard]] nlohmann::ordered_json make_summary(const RunDescription& run, const mesh::TetMesh& mesh,
                                                  const model::Model& model, const model::Loading& loading,
                                                  const Measures& measures, const solver::Report& report,
                                                  const RunTimes& times);

/// Rhexis and the libraries it runs with.
[[nodiscard]] nlohmann::ordered_json versions();

/// Largest resident size of this process so far, bytes.
[[nodiscard]] std::size_t peak_memory_bytes();

}  // namespace rhexis::result
