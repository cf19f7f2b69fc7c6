#pragma once

/// Restructuring time per advance (Fig. 5.7 of the thesis; docs/restructuring.md): what it takes from one topology to
/// the next, by several ways on the same advances of the same plates.

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "result/chart.h"
#include "studies/study_folder.h"

namespace rhexis::studies {

/// In the order of studies::TearMode.
inline constexpr std::array<std::string_view, 2> kTearModes{"imposed", "slow-pull"};

/// dense-inverse: the conventional way of the thesis, all free dofs inverted; up to kDenseNodes.
/// sparse: the whole torn body assembled, analysed and factored (CHOLMOD).
/// local: the local object of the thesis: re-meshing, and the local object made anew and factored.
/// exact: all that the program does: re-meshing, local object, and the exact response of the whole torn body, as it is
/// waited for while the next window is made ready in the background.
/// exact-all-work: the same with nothing in the background: what the background does is in the time.
inline constexpr std::array<std::string_view, 5> kWays{"dense-inverse", "sparse", "local", "exact", "exact-all-work"};

/// A dense inverse of this many nodes holds 0.2 GB and takes seconds.
inline constexpr int kDenseNodes = 1300;

/// The plates of Fig. 5.7.
inline constexpr std::array<int, 4> kThesisNodes{506, 765, 1012, 1270};

struct RestructuringOptions {
  std::vector<int> nodes{506, 765, 1012, 1270, 5000, 20000, 100000};
  std::vector<std::string> modes{kTearModes.begin(), kTearModes.end()};
  std::vector<std::string> ways{kWays.begin(), kWays.end()};
  /// s: a plate is torn again from its start while all that was done with it took less than this, kMostRounds at most.
  double seconds_per_case = 20.0;
};
inline constexpr int kMostRounds = 10;

/// Runs the study and writes restructuring.csv, .json and .svg, anew after every plate and mode. Gives the rows, one
/// per plate, mode and way that was timed at all, ordered by them. Errors: an unknown mode or way, a plate that cannot
/// be, a folder that cannot be written to; stopped before there was a row.
///
/// Of a row: nodes (as asked for), mode, way, advances (how many were timed), ms_per_advance (their mean) and its
/// spread (ms_median, ms_least, ms_most), ms_per_tet (removed), tets_per_advance, length_mm (mean advance),
/// sparse_over_this (how many times longer `sparse` took in the same rounds), the means of the parts (remesh_ms,
/// local_ms, update_ms, of which wait_ms; assembly_ms, analysis_ms, factor_ms), mesh_nodes, mesh_tets, threads. What a
/// way does not have is null.
Expected<nlohmann::ordered_json> run_restructuring(const RestructuringOptions& options, const StudyFolder& folder,
                                                   const Progress& progress);

/// The rows over the number of nodes, both axes logarithmic, beside the points of the thesis.
[[nodiscard]] result::Chart restructuring_chart(const nlohmann::ordered_json& rows);

}  // namespace rhexis::studies
