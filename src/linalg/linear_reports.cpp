#include "linalg/linear_reports.h"

#include <fmt/format.h>

#include <utility>

namespace rhexis::linalg {

LinearReport failure(LinearOutcome outcome, std::string message) {
  LinearReport report;
  report.outcome = outcome;
  report.message = std::move(message);
  return report;
}

LinearReport bad_matrix() { return failure(LinearOutcome::not_finite, "the matrix has an entry that is not a number"); }

LinearReport bad_right_hand_side() {
  return failure(LinearOutcome::not_finite, "the right-hand side has an entry that is not a number");
}

LinearReport out_of_memory(const SaddleMatrix& K) {
  return failure(LinearOutcome::not_supported,
                 fmt::format("the factors of {} unknowns do not fit into memory: take a coarser mesh",
                             K.displacement_unknowns() + K.pressure_unknowns()));
}

LinearReport indefinite(std::string_view what) {
  return failure(LinearOutcome::indefinite,
                 fmt::format("{} is not positive definite, which conjugate gradients need: take smaller load steps, or "
                             "linear = \"direct\", which also counts the negative pivots",
                             what));
}

LinearReport not_converged(LinearReport so_far, double tolerance) {
  so_far.outcome = LinearOutcome::not_converged;
  so_far.message =
      fmt::format("{} iterations left a relative residual of {:.1e}, {:.1e} was asked: take linear = \"direct\"",
                  so_far.iterations, so_far.relative_residual, tolerance);
  return so_far;
}

LinearReport skew_not_supported(std::string_view solver) {
  return failure(
      LinearOutcome::not_supported,
      fmt::format("a follower pressure on a surface with a free rim makes the tangent non-symmetric, which {} "
                  "cannot solve: hold the rim, or take linear = \"direct\"",
                  solver));
}

}  // namespace rhexis::linalg
