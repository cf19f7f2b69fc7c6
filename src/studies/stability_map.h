#pragma once

/// Which couplings an emulated device bears (docs/haptics.md): stiffness against delay, with the control of energy and
/// without, beside the analytic bound.

#include <vector>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "haptics/emulator_device.h"
#include "result/chart.h"
#include "studies/study_folder.h"

namespace rhexis::studies {

struct StabilityOptions {
  /// N/m, of the coupling before a body that hardly gives way.
  std::vector<double> stiffness{250, 350, 500, 700, 1000, 1400, 2000, 2800, 4000, 5600, 8000, 11200};
  std::vector<int> delay{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};  ///< ticks, beyond none
  haptics::EmulatorSettings device;                              ///< its delay is not read
  double damping = 1.5;                                          ///< N s/m, of the coupling
  double seconds = 4.0;                                          ///< of each run
};

/// m: a loop whose device stays within this over the last second is at rest. Five steps of 0.06 mm, among which a loop
/// without friction may hop however stable it is.
inline constexpr double kAtRest = 3e-4;

/// Writes haptic-stability.csv, .json and .svg. Gives the rows, one per stiffness and delay. Errors: a stiffness, a
/// delay, a device that cannot be; a folder that cannot be written to. Stopped, it gives the rows that there are.
///
/// Of a row: stiffness (N/m), delay_ms, bound (N/m, the analytic one), over_bound (stiffness / bound), and for the loop
/// without control of energy and with it (`_free`, `_kept`): rests, shake_mm (over the last second), force_N (the
/// largest), given_mJ; gain (with control, at the end).
Expected<nlohmann::ordered_json> run_stability_map(const StabilityOptions& options, const StudyFolder& folder,
                                                   const Progress& progress);

/// The rows, stiffness (logarithmic) over delay.
[[nodiscard]] result::Chart stability_chart(const nlohmann::ordered_json& rows);

}  // namespace rhexis::studies
