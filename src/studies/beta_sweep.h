#pragma once

/// What the factor of the pressure stabilisation does (Fig. 3 and 4 of the paper; docs/studies.md): study
/// `stabilisation`.

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "result/chart.h"
#include "studies/study_folder.h"

namespace rhexis::studies {

struct BetaSweepOptions {
  int nodes = 401;         ///< of the vessel
  double density = 500.0;  ///< kg/m3, as Fig. 3
};

/// Writes stabilisation.csv, .json (one row per kappa and beta: kappa (Pa), choice ("paper", "auto", "sweep"), beta,
/// pressure_jump, lambda_mean (Pa, of |lambda|), volume_ratio, min_J, max_J, error_u_percent and error_lambda_percent
/// (L2, from taylor-hood on the refined mesh), iterations, smoothing_mm), the figures stabilisation-errors,
/// stabilisation-lambda-BETA and the shapes. Gives the rows of kappa of Table 3 that the paper has, and auto.
/// Errors: a vessel that cannot be, a trusted answer that does not converge; stopped before that.
Expected<nlohmann::ordered_json> run_beta_sweep(const BetaSweepOptions& options, const StudyFolder& folder,
                                                const Progress& progress);

/// Errors and jump over beta, both axes logarithmic; levels without stabilisation dashed.
[[nodiscard]] result::Chart beta_chart(const nlohmann::ordered_json& rows, double kappa);

}  // namespace rhexis::studies
