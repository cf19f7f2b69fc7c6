#pragma once

/// Where the six models part from each other and from the trusted answer (Table 5 and Fig. 5 of the paper;
/// docs/studies.md): study `models`.

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "studies/study_folder.h"

namespace rhexis::studies {

struct ModelComparisonOptions {
  int nodes = 401;                                           ///< of the vessel
  std::vector<double> densities{500.0, 5000.0};              ///< kg/m3
  std::filesystem::path shared = "../shared";                ///< where meshes of organs may lie, in data/
  std::vector<std::string> organs{"kidney_1k", "liver_1k"};  ///< those that are not there are left out
};

/// Writes models.csv, .json: one row per body, density (kg/m3), model and `from` ("psh", beta = 100, as the paper;
/// "taylor-hood", the trusted one: of the vessel on the refined mesh), of mean, max (percent of the box, over nodes and
/// components), mean_x .. max_z, converged, load (fraction reached), iterations, volume_ratio, inverted_tets,
/// smallest_J. models-departure: the strain and load fraction at which a model's largest difference from the trusted
/// answer passes 1, 5 and 10%, null where it never does. Pictures of the shapes, figures of the difference over strain.
/// Gives the rows of models from psh. Errors: a vessel that cannot be, an organ's file that cannot be read, a trusted
/// answer or PSH that does not converge; stopped before the first body was done.
Expected<nlohmann::ordered_json> run_model_comparison(const ModelComparisonOptions& options, const StudyFolder& folder,
                                                      const Progress& progress);

}  // namespace rhexis::studies
