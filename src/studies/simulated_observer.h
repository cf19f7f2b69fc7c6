#pragma once

/// Observers whose psychometric function is known, which prove rules and analysis.

#include <cstdint>
#include <vector>

#include "studies/perception_experiment.h"

namespace rhexis::studies {

/// Goes through the whole experiment of that seed; the observer's own draws come from another stream.
[[nodiscard]] std::vector<AnsweredTrial> observe(const PerceptionSettings& settings, const Psychometric& truth,
                                                 std::uint64_t seed);

/// What a rule makes of many observers of one function.
struct RuleTrial {
  double trials = 0.0;    ///< mean
  double bounded = 0.0;   ///< part of the observers whose answers bound a threshold; what follows is of these
  double estimate = 0.0;  ///< degrees, geometric mean of the fitted thresholds
  double bias = 0.0;      ///< mean of ln (estimate / threshold)
  double spread = 0.0;    ///< standard deviation of the same
  double held = 0.0;      ///< part of the 95% intervals that hold the threshold
  double own = 0.0;       ///< degrees, geometric mean of what the rule itself says; 0: nothing
};
/// Observers of seeds `seed` on; the same whatever the number of threads.
[[nodiscard]] RuleTrial try_rule(const PerceptionSettings& settings, const Psychometric& truth, int observers,
                                 std::uint64_t seed);

}  // namespace rhexis::studies
