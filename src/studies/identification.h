#pragma once

/// Whether the hyperelastic model without stabilisation is what another program computes (Table 4 of the paper), and
/// how far it is from the trusted answer (docs/studies.md).

#include <filesystem>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "studies/study_folder.h"

namespace rhexis::studies {

struct IdentificationOptions {
  int nodes = 401;                             ///< of the vessel
  std::filesystem::path shared = "../shared";  ///< where other programs' solutions may lie, in reference/
};

/// Writes identification.csv, .json: one row per density and other answer, of body, rho (kg/m3), against, nodes, tets,
/// mean_percent (mean over the nodes of |du| / |u|), component_percent (as the paper: mean over nodes and components of
/// |du_i| / |u_i|, where |u_i| is above a millionth of the largest; a few small components decide it, so their median
/// stands beside it), component_median_percent, box_percent_mean, box_percent_max (of the bounding
/// box, largest component), largest_mm. Also identification-nodes (nodes 1, 100, ... as in Table 4) and pictures.
/// Gives the rows. Errors: a vessel that cannot be, a solution that does not converge, a file of another program that
/// cannot be read.
Expected<nlohmann::ordered_json> run_identification(const IdentificationOptions& options, const StudyFolder& folder,
                                                    const Progress& progress);

}  // namespace rhexis::studies
