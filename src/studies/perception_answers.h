#pragma once

/// Answers that were given to an experiment on crack angles: by a person at the page (apps), or by a script.

#include <filesystem>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "studies/perception_experiment.h"
#include "studies/study_folder.h"

namespace rhexis::studies {

/// Writes the tables of answers that were given: angle-perception (source "answers", then "thesis"; what it gives),
/// angle-perception-trials, angle-perception-fit. Errors: not an answer yet, a folder that cannot be written to.
Expected<nlohmann::ordered_json> write_answers(const PerceptionSettings& settings,
                                               const std::vector<AnsweredTrial>& answered, const StudyFolder& folder);

/// A script answers: line n of `answers`, A or B, is the answer to trial n; what is blank or begins with # is none.
/// Goes on where `folder` has the answers to the first trials already. Errors, with which no answer is kept: as of
/// PerceptionPlate and TrialLog; no answer; another line, more answers than trials, one that differs from what was
/// answered, each with its line.
Expected<nlohmann::ordered_json> run_scripted_answers(const PerceptionSettings& settings,
                                                      const std::filesystem::path& answers, const StudyFolder& folder,
                                                      const Progress& progress);

}  // namespace rhexis::studies
