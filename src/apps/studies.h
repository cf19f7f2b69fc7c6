#pragma once

/// The one list of studies: what `rhexis study NAME` can be, and what `rhexis study all` runs.

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>

#include "studies/study_folder.h"

namespace rhexis::apps {

/// Gives the rows of the study's first table, having written all that it writes.
using StudyFunction =
    std::function<Expected<nlohmann::ordered_json>(const studies::StudyFolder&, const studies::Progress&)>;

struct Study {
  std::string_view name;
  std::string_view title;          ///< one line
  std::string_view example;        ///< its options in the example of --help
  std::vector<std::string> shown;  ///< columns of the rows that are printed for people
  /// Adds its options to its command, and gives what runs with them: with the defaults, when nothing is parsed.
  std::function<StudyFunction(CLI::App&)> with_options;
};

/// In the order in which `all` runs them.
[[nodiscard]] std::span<const Study> all_studies();

}  // namespace rhexis::apps
