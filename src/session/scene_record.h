#pragma once

/// The record that belongs to a scene: what `rhexis precompute` is asked for, and what `response = "recorded"` reads.

#include <string>
#include <vector>

#include "base/error.h"
#include "record/build/campaign.h"
#include "response/recorded_response.h"
#include "scene/tear_problem.h"

namespace rhexis::session {

/// `program`: "rhexis 0.1.0". The problem has one crack.
[[nodiscard]] record::build::CampaignRequest record_request(const scene::TearProblem& problem, std::string program);

/// All of the file that `[interaction] record` names, held against the scene: the mesh, the material, the supports, the
/// loads and the crack have to be those it was made of. How many advances, directions and lengths it has, it says
/// itself, and so does it the program that made it. Errors name the file, what is wrong with it, and the command that
/// makes it.
[[nodiscard]] Expected<response::SharedRecord> load_record(const scene::TearProblem& problem);

/// What `use` says beyond `before`, in words; one line each.
[[nodiscard]] std::vector<std::string> remarks_on(const response::RecordUse& use, const response::RecordUse& before);

}  // namespace rhexis::session
