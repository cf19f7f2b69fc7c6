#pragma once

/// Iterative solvers stop at a residual that a recurrence carries along, and which drifts. Here the true one is
/// measured, and the iteration taken up again from it while that helps.

#include <string_view>

#include "linalg/conjugate_gradients.h"
#include "linalg/linear_reports.h"
#include "linalg/saddle_residual.h"

namespace rhexis::linalg {

/// `run(most)` improves (xu, xp) by at most `most` iterations, starting from residual.u() and residual.p(); it returns
/// a CgResult. `norm` is that of the right-hand side; (xu, xp) are zero on entry.
template <class Run>
LinearReport iterate_measured(SaddleResidual& residual, const VectorX& bu, const VectorX& bp, double norm,
                              double tolerance, int max_iterations, std::string_view operator_name, const Run& run,
                              VectorX& xu, VectorX& xp) {
  constexpr int kMostRounds = 4;
  LinearReport report;
  double last = residual.measure(bu, bp, xu, xp) / norm;
  for (int round = 0; round < kMostRounds; ++round) {
    const CgResult result = run(max_iterations - report.iterations);
    report.iterations += result.iterations;
    report.relative_residual = residual.measure(bu, bp, xu, xp) / norm;
    if (result.end == CgEnd::negative_curvature) {
      LinearReport bad = indefinite(operator_name);
      bad.iterations = report.iterations;
      bad.relative_residual = report.relative_residual;
      return bad;
    }
    if (report.relative_residual <= tolerance) return report;
    if (result.end == CgEnd::too_many_iterations || !(report.relative_residual < 0.5 * last)) break;
    last = report.relative_residual;
  }
  return not_converged(report, tolerance);
}

}  // namespace rhexis::linalg
