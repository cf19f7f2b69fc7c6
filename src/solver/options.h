#pragma once

#include <string>

namespace rhexis::solver {

struct Options {
  std::string linear = "direct";  ///< "direct", "cg", "minres" (linalg/saddle_solver.h)
  double tolerance = 1e-8;        ///< on |R_u| / max(|internal|, |external|) and |R_lambda| / |V (J - 1)|
  int steps = 10;                 ///< load steps asked for; cut where one does not converge
  int max_iterations = 30;        ///< Newton iterations a step
  int max_cuts = 12;              ///< halvings of a whole step before giving up; five times as many cuts end a run
};

}  // namespace rhexis::solver
