#pragma once

/// How far recorded forces are from the exact ones (Tables 5.9 and 5.10 of the thesis; docs/reaction-error.md): on the
/// plate of the thesis, for every degree of the crack's angle, every free node of the surface and every recorded pull.

#include <vector>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "studies/study_folder.h"

namespace rhexis::studies {

struct ReactionErrorOptions {
  int nodes = 506;                                      ///< of the plate
  std::vector<int> advances{1, 2};                      ///< each a table of its own: 1, 2
  double spacing = 15.0;                                ///< degrees, of the record
  std::vector<double> spacings{30.0, 15.0, 7.5, 3.75};  ///< degrees, of the records that are compared, one advance
  int step = 1;                                         ///< degrees between the angles that are asked for
};

/// Runs the study and writes its tables and figures. Gives the rows of the first of them, reaction-error: one per
/// number of advances and way (studies::kReactionWays). Errors: a plate that cannot be; a spacing or a step that does
/// not divide 180 degrees; other advances; a folder that cannot be written to; stopped before the first table was
/// whole.
///
/// Of a row: advances, way, patterns, torn_off (patterns left out: the point has come off in one of the topologies),
/// better (share of patterns in which the error is less than that of `nearest`), tied (share in which it is the same),
/// better_untied (share of the others), mean, deviation (of the error, divided by the largest of the ways of the thesis
/// for that number of advances), mean_N, deviation_N, largest_N, mean_relative, deviation_relative (of the exact
/// force), and thesis_better, thesis_mean, thesis_deviation, null where it has none.
Expected<nlohmann::ordered_json> run_reaction_error(const ReactionErrorOptions& options, const StudyFolder& folder,
                                                    const Progress& progress);

}  // namespace rhexis::studies
