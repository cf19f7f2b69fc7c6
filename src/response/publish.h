#pragma once

/// From the law of a contact to what the haptic loop reads.

#include <cstdint>

#include "response/contact.h"
#include "response/snapshot.h"

namespace rhexis::response {

/// Held, up to date. `force_limit`: N, 0 for none.
[[nodiscard]] ForceSnapshot make_snapshot(const ContactLaw& law, double force_limit, std::uint64_t topology);

}  // namespace rhexis::response
