#pragma once

/// The figures of the study angle-perception.

#include <span>
#include <string>

#include <nlohmann/json.hpp>

#include "result/chart.h"
#include "studies/perception_analysis.h"
#include "studies/psychometric.h"

namespace rhexis::studies {

/// Part of right answers over the difference: what was counted, by class where there are classes, and the fitted
/// function.
[[nodiscard]] result::Chart answers_chart(const std::string& title, std::span<const AnswerCount> answers,
                                          const std::optional<PsychometricFit>& fit);
/// Of angle-perception-rules: fitted over true threshold, with the spread of the fits as whiskers.
[[nodiscard]] result::Chart rules_chart(const nlohmann::ordered_json& rows);
/// Of angle-perception-feel: change of the force over the difference, a line a point and direction.
[[nodiscard]] result::Chart feel_chart(const nlohmann::ordered_json& rows);

}  // namespace rhexis::studies
