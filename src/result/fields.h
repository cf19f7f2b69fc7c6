#pragma once

/// What a state looks like to ParaView and to `rhexis compare`: the fields of section "Results" of docs/results.md.

#include <vector>

#include "base/vec.h"
#include "mesh/field.h"
#include "mesh/tet_mesh.h"
#include "model/model.h"

namespace rhexis::result {

/// PointData `displacement` (m) and `reaction` (N), CellData `lambda`, `pressure` (= -lambda), `stress` (Cauchy),
/// `principal_max`, `von_mises` (all Pa) and `J`; Taylor-Hood adds `lambda` on the points. Only the nodes of the mesh,
/// in its order. `tets` is model.fields(state). `reaction` has 3 values per node of the model's displacement space, or
/// is empty: the field is left out then.
[[nodiscard]] std::vector<mesh::Field> make_fields(const mesh::TetMesh& mesh, const model::Model& model,
                                                   const model::State& state, const model::TetFields& tets,
                                                   const VectorX& reaction);

/// The CellData of it that come from the tets alone: lambda, pressure, stress, principal_max, von_mises and J.
[[nodiscard]] std::vector<mesh::Field> fields_of_tets(const model::TetFields& tets);

/// Numbers of a state that the summary reports.
struct Measures {
  double volume_ratio = 1.0;  ///< deformed over reference volume
  int inverted_tets = 0;      ///< tets with J <= 0
  double pressure_jump =
      0.0;  ///< area-weighted RMS of the jumps of lambda over interior faces / volume-weighted mean |lambda|
  double max_displacement = 0.0;  ///< m
};
[[nodiscard]] Measures measure(const mesh::TetMesh& mesh, const model::State& state, const model::TetFields& tets);

}  // namespace rhexis::result
