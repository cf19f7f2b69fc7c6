#pragma once

/// The rows that simulated and given answers have in common.

#include <optional>
#include <span>
#include <string_view>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "studies/perception_analysis.h"
#include "studies/psychometric.h"
#include "studies/study_folder.h"

namespace rhexis::studies {

[[nodiscard]] nlohmann::ordered_json or_null(const std::optional<double>& value);

/// Of angle-perception: source, from, to (degrees; null: no end), trials, right, critical, told.
[[nodiscard]] nlohmann::ordered_json class_row(std::string_view source, const DifferenceClass& one);

/// Of angle-perception-fit: source, trials, threshold, low, high (degrees), slope, lapse; null where nothing is
/// bounded.
[[nodiscard]] nlohmann::ordered_json fit_row(std::string_view source, std::span<const AnswerCount> answers,
                                             const std::optional<PsychometricFit>& fit);

/// The table of such rows.
Expected<void> write_fit(const StudyFolder& folder, const nlohmann::ordered_json& rows);

}  // namespace rhexis::studies
