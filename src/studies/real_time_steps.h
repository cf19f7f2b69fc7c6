#pragma once

/// One Newton iteration per simulation step (6.3 of the paper): the load moves at the speed of a hand, and each step
/// takes up where it is when the step before has ended.

#include <string>

#include "studies/loaded_body.h"

namespace rhexis::studies {

struct RealTimeSteps {
  double step_seconds = 0.0;     ///< of one iteration, median of a run before
  int steps = 0;                 ///< in which the whole load was gone through
  bool held = true;              ///< false: a tet inverted, or a linear system was not solved, on the way
  double largest_mm = 0.0;       ///< distance of a node from equilibrium at the same load, over the whole way
  double mean_mm = 0.0;          ///< mean over the nodes, at the worst step that was looked at
  double largest_percent = 0.0;  ///< of the bounding box, largest component
};

/// `hand`: m/s, of the support that moves most. Equilibria to compare with are computed at eight loads.
[[nodiscard]] RealTimeSteps step_in_real_time(const LoadedBody& body, const model::ModelSettings& settings,
                                              const std::string& linear, double hand);

}  // namespace rhexis::studies
