#pragma once

/// How far a model is from the trusted answer while the load grows.

#include <optional>
#include <vector>

#include "studies/loaded_body.h"

namespace rhexis::studies {

/// One load step of both.
struct PathPoint {
  double load = 0.0;        ///< fraction
  double strain = 0.0;      ///< of the trusted answer, as strain_of has it
  double difference = 0.0;  ///< percent of the box, largest over nodes and components
};

/// |stretch - 1| that 95% of the volume do not exceed; the stretch is the principal one furthest from 1 (no unit).
[[nodiscard]] double strain_of(const mesh::TetMesh& mesh, const VectorX& u);

/// The point at which `difference` first passes a limit, between two steps in proportion; empty: it never does. A path
/// begins at nothing.
[[nodiscard]] std::optional<PathPoint> passes(const std::vector<PathPoint>& path, double limit);

}  // namespace rhexis::studies
