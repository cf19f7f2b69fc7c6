#pragma once

/// `rhexis study angle-perception --with person`: the experiment in the page.

#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "apps/live_view.h"
#include "haptics/pointer_device.h"
#include "studies/perception_settings.h"
#include "studies/study_folder.h"

namespace rhexis::apps {

struct PersonOptions {
  std::shared_ptr<LiveViewOptions> view;
  std::string device{haptics::PointerDevice::kName};
  double motion_scale = 1.0;
  /// A plate resists with up to 2 N a millimetre, and a device gives some 9 N: a force that is cut tells nothing.
  double force_scale = 0.1;
};

/// Until the last trial is answered, or Ctrl-C; answers go into `folder`, where the same experiment goes on the next
/// time. One that is at its end has its tables written again, without a page. Errors: as of PerceptionTask, LiveSession
/// and the server; not an answer.
Expected<nlohmann::ordered_json> run_with_person(const studies::PerceptionSettings& settings,
                                                 const PersonOptions& person, const studies::StudyFolder& folder,
                                                 const studies::Progress& progress);

}  // namespace rhexis::apps
