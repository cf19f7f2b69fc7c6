#pragma once

/// report.html: one self-contained page a study, that asks nobody for anything; and study.json, the same for programs.

#include <filesystem>
#include <string>
#include <vector>

#include "base/error.h"
#include "studies/study_folder.h"

namespace rhexis::studies {

struct StudyRun {
  std::string study;    ///< its name
  std::string title;    ///< what it asks, one line
  std::string command;  ///< as it was typed
  double seconds = 0.0;
  int threads = 0;
  bool stopped = false;  ///< before its end: the tables hold what was measured until then
};

/// Writes study.json (study, title, command, seconds, threads, stopped, published, tables, figures, versions, machine)
/// and report.html. `viewer`: the script that turns shapes with the mouse, as `make viewer` builds it; where there is
/// none the pictures stand still, and the page says how to get it.
Expected<void> write_report(const StudyFolder& folder, const StudyRun& run, const std::filesystem::path& viewer);

/// index.html over the reports of these studies, which lie in folders of their names below `folder`.
Expected<void> write_report_index(const std::filesystem::path& folder, const std::vector<StudyRun>& runs);

/// A number, word or nothing as people read it: four digits, "–" where there is nothing. Not escaped.
[[nodiscard]] std::string cell_text(const nlohmann::ordered_json& value);

}  // namespace rhexis::studies
