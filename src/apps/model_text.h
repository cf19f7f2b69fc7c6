#pragma once

#include <string>

#include "scene/problem.h"

namespace rhexis::apps {

/// "hyperelastic, beta 100"
inline std::string model_text(const scene::Problem& problem) {
  return problem.model->name() == "hyperelastic" ? fmt::format("hyperelastic, beta {:.4g}", problem.settings.beta)
                                                 : std::string(problem.model->name());
}

}  // namespace rhexis::apps
