#pragma once

/// The folder a run leaves behind: result.vtkhdf, steps.pvd with a VTU per step, summary.json. Every file appears
/// whole; a run that is killed keeps the steps it finished.

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "mesh/field.h"
#include "mesh/io/mesh_file.h"
#include "mesh/tet_mesh.h"

namespace rhexis::result {

class ResultFolder {
 public:
  /// Makes the folder and removes the result, summary and steps of an earlier run in it, half-written ones of a run
  /// that was killed too, so that nothing stale is taken for new and nothing piles up.
  static Expected<ResultFolder> open(const std::filesystem::path& path);

  /// Writes steps/step_NNNN.vtu and the series up to it. `load`: fraction of the whole load, the series' value.
  Expected<void> write_step(double load, const mesh::TetMesh& mesh, const std::vector<mesh::Field>& fields);
  /// Writes steps/topology_NNNN.vtu and .vtkhdf and the series up to it, whose value is `topology`.
  Expected<void> write_topology(std::size_t topology, const mesh::TetMesh& mesh,
                                const std::vector<mesh::Field>& fields);
  /// Writes steps/released_NNNN.vtu and the series released.pvd up to it, whose value is `time` (s).
  Expected<void> write_released(double time, const mesh::TetMesh& mesh, const std::vector<mesh::Field>& fields);
  Expected<void> write_result(const mesh::TetMesh& mesh, const std::vector<mesh::Field>& fields);
  Expected<void> write_summary(const nlohmann::ordered_json& summary);

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  explicit ResultFolder(std::filesystem::path path) : path_(std::move(path)) {}

  std::filesystem::path path_;
  std::vector<mesh::SeriesEntry> series_;
  std::vector<mesh::SeriesEntry> released_;
};

}  // namespace rhexis::result
