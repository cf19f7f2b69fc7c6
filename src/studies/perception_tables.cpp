#include "studies/perception_tables.h"

namespace rhexis::studies {

using nlohmann::ordered_json;

ordered_json or_null(const std::optional<double>& value) {
  return value ? ordered_json(*value) : ordered_json(nullptr);
}

ordered_json class_row(std::string_view source, const DifferenceClass& one) {
  return {{"source", source},   {"from", one.from},           {"to", or_null(one.to)}, {"trials", one.trials},
          {"right", one.right}, {"critical", one.critical()}, {"told", one.is_told()}};
}

ordered_json fit_row(std::string_view source, std::span<const AnswerCount> answers,
                     const std::optional<PsychometricFit>& fit) {
  int trials = 0;
  for (const AnswerCount& count : answers) trials += count.trials;
  ordered_json row{{"source", source}, {"trials", trials}};
  row["threshold"] = fit ? ordered_json(fit->function.threshold) : ordered_json(nullptr);
  row["low"] = fit ? or_null(fit->low) : ordered_json(nullptr);
  row["high"] = fit ? or_null(fit->high) : ordered_json(nullptr);
  row["slope"] = fit ? ordered_json(fit->function.slope) : ordered_json(nullptr);
  row["lapse"] = fit ? ordered_json(fit->function.lapse) : ordered_json(nullptr);
  return row;
}

Expected<void> write_fit(const StudyFolder& folder, const ordered_json& rows) {
  return folder.write_table(
      "angle-perception-fit", rows,
      "The difference at which three of four answers are right but for lapses (degrees), with its 95% interval "
      "by profile likelihood; an "
      "empty end is not bounded by the answers.");
}

}  // namespace rhexis::studies
