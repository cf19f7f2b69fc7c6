#pragma once

/// The same bar in CalculiX, an independent finite-element program, for the converged answer. It is run as a program of
/// its own, `ccx` from the PATH, on one thread.

#include <optional>

#include "base/vec.h"
#include "bench/rivals/bar.h"

namespace rhexis::rivals {

enum class CalculixLaw {
  linear,               ///< *ELASTIC
  st_venant_kirchhoff,  ///< *ELASTIC with NLGEOM
  neo_hookean,          ///< *HYPERELASTIC, NEO HOOKE: c1 (I1 J^(-2/3) - 3) + kappa/2 (J - 1)^2
};

struct CalculixAnswer {
  VectorX u;             ///< m, in the six digits that it prints
  double seconds = 0.0;  ///< of the whole run
};

[[nodiscard]] bool is_calculix_here();
/// Empty: it gave no answer.
[[nodiscard]] std::optional<CalculixAnswer> run_calculix(const Bar& bar, CalculixLaw law, const Vec3& hand);

}  // namespace rhexis::rivals
