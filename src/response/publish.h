#pragma once

/// From the law of a contact to what the haptic loop reads.

#include <cstdint>

#include "base/vec.h"
#include "response/contact.h"
#include "response/snapshot.h"

namespace rhexis::response {

/// What a snapshot says beside its law.
struct Publication {
  std::uint64_t number = 0;
  std::uint64_t topology = 0;
  std::uint32_t grasp = 0;
  double force_limit = 0.0;   ///< N; 0 for none
  Vec3 start = Vec3::Zero();  ///< m: `rest` of the law when the hand took hold
};

/// Held, up to date.
[[nodiscard]] ForceSnapshot make_snapshot(const ContactLaw& law, const Publication& of);

}  // namespace rhexis::response
