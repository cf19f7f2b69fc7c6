#pragma once

/// Which crack angles a hand can tell apart (Table 5.4 of the thesis; docs/angle-perception.md): the thesis's counts
/// under its own test, simulated observers under three rules, and the answers of people or scripts.

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

/// The same tables of answers that were given: angle-perception (source "answers", then "thesis"),
/// angle-perception-trials, angle-perception-fit. Errors: not an answer yet, a folder that cannot be written to.
Expected<nlohmann::ordered_json> write_answers(const PerceptionSettings& settings,
                                               const std::vector<AnsweredTrial>& answered, const StudyFolder& folder);

/// A script answers: line n of `answers`, A or B, is the answer to trial n; what is blank or begins with # is none.
/// Goes on where `folder` has the answers to the first trials already. Errors: as of TrialLog; another line, more
/// answers than trials, one that differs from what was answered, each with its line.
Expected<nlohmann::ordered_json> run_scripted_answers(const AnglePerceptionOptions& options,
                                                      const std::filesystem::path& answers, const StudyFolder& folder,
                                                      const Progress& progress);

}  // namespace rhexis::studies
