#pragma once

/// How a body of each model keeps up with a hand (section 6.3 of the paper; docs/live-models.md): frames a second, and
/// the force between frames against the converged one of the same instant.

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "result/chart.h"
#include "studies/study_folder.h"

namespace rhexis::studies {

struct LiveModelsOptions {
  std::vector<int> nodes{300, 2100, 10000};  ///< about 1,000, 10,000 and 50,000 tets
  std::vector<std::string> models{"corotated", "geometrically-nonlinear", "hyperelastic"};
  std::vector<double> speeds{0.01, 0.05, 0.1};  ///< m/s, of the hand
  double seconds = 2.0;                         ///< of each motion
  int samples = 6;                              ///< instants of each at which the converged force is computed
  int corrections = 1;                          ///< of a frame
  double frame = 0.0;  ///< s, that every frame counts as; 0: as long as it takes, kFramePeriod at least
};

/// A frame never begins sooner after the one before.
inline constexpr double kFramePeriod = 1.0 / 60.0;

/// Writes live-models.csv, .json and .svg, anew after every motion. Gives the rows, one per body, model and speed.
/// Errors: a body that cannot be, a model that cannot be moved, numbers that are not positive; stopped before there was
/// a row.
///
/// Of a row: nodes, tets, model, speed_mm_s, frames_per_s (60 at most), frame_ms (median), frame_ms_most, late (share
/// of frames after which the point was not where the hand was at their start), iterations (of conjugate gradients a
/// frame, mean), residual (relative, median), error_mean, error_most (of the force between frames, relative to the
/// largest converged force of the motion), force_N (that), oracle_failed (samples whose converged solve failed).
Expected<nlohmann::ordered_json> run_live_models(const LiveModelsOptions& options, const StudyFolder& folder,
                                                 const Progress& progress);

[[nodiscard]] result::Chart live_models_chart(const nlohmann::ordered_json& rows);

}  // namespace rhexis::studies
