#include "linalg/saddle_solver.h"

#include "base/check.h"
#include "linalg/direct_solver.h"

namespace rhexis::linalg {

std::unique_ptr<SaddleSolver> make_saddle_solver(std::string_view name, const BlockPreconditioner* blocks) {
  static_cast<void>(blocks);
  RHEXIS_CHECK(name == "direct", "no linear solver '{}'", name);
  return std::make_unique<DirectSolver>();
}

}  // namespace rhexis::linalg
