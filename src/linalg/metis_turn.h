#pragma once

#include <mutex>

namespace rhexis::linalg {

/// To be held while METIS runs. It draws from the process's one rand(), which it seeds at the start of a call: two
/// calls at once would draw from each other, and what they find would depend on timing.
[[nodiscard]] std::unique_lock<std::mutex> take_metis_turn();

}  // namespace rhexis::linalg
