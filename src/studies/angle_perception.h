#pragma once

/// Which crack angles a hand can tell apart (Table 5.4 of the thesis; docs/angle-perception.md): the thesis's counts
/// under its own test, and simulated observers under three rules.

#include <filesystem>
#include <optional>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "studies/perception_experiment.h"
#include "studies/study_folder.h"

namespace rhexis::studies {

struct AnglePerceptionOptions {
  std::filesystem::path experiment;                 ///< file; empty: that of the thesis
  std::optional<std::uint64_t> seed;                ///< in place of the file's
  int observers = 200;                              ///< simulated, of each threshold and rule
  std::vector<double> thresholds{8.0, 15.0, 30.0};  ///< degrees, of the simulated observers

  [[nodiscard]] Expected<PerceptionSettings> settings() const;
};

/// Simulated observers, and the thesis's counts. Writes and gives angle-perception (a row a class of Table 5.4: source,
/// from, to in degrees, trials, right, critical, told, expected_trials, expected_right); writes
/// angle-perception-rules (a row a rule and threshold), angle-perception-fit, angle-perception-feel (what there is to
/// feel: a row a point, direction and difference) and the figures of all. Errors: an experiment or a plate that cannot
/// be, thresholds that differences do not reach.
Expected<nlohmann::ordered_json> run_angle_perception(const AnglePerceptionOptions& options, const StudyFolder& folder,
                                                      const Progress& progress);

}  // namespace rhexis::studies
