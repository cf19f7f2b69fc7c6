#pragma once

/// What the linear solvers say when something is wrong, in one place: docs/solvers.md explains these lines to users.

#include <string>
#include <string_view>

#include "linalg/saddle_solver.h"

namespace rhexis::linalg {

inline constexpr std::string_view kSingularHelp =
    "a part of the body may be free to move or to turn, or a node may have no stiffness: hold it";

[[nodiscard]] LinearReport failure(LinearOutcome outcome, std::string message);
[[nodiscard]] LinearReport bad_matrix();
[[nodiscard]] LinearReport bad_right_hand_side();
[[nodiscard]] LinearReport out_of_memory(const SaddleMatrix& K);
/// `what`: the matrix that turned out not to be positive definite.
[[nodiscard]] LinearReport indefinite(std::string_view what);
/// Fills in the outcome and the message of an iteration that ended above its tolerance.
[[nodiscard]] LinearReport not_converged(LinearReport so_far, double tolerance);
[[nodiscard]] LinearReport skew_not_supported(std::string_view solver);

}  // namespace rhexis::linalg
