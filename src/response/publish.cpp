#include "response/publish.h"

namespace rhexis::response {

ForceSnapshot make_snapshot(const ContactLaw& law, double force_limit, std::uint64_t topology) {
  ForceSnapshot out;
  for (int i = 0; i < 3; ++i) {
    const auto at = static_cast<std::size_t>(i);
    out.rest[at] = law.rest[i];
    out.normal[at] = law.normal[i];
    for (int j = 0; j < 3; ++j) out.stiffness[3 * at + static_cast<std::size_t>(j)] = law.stiffness(i, j);
  }
  out.force_limit = force_limit;
  out.topology = topology;
  out.flags = ForceSnapshot::is_held;
  if (law.mode == ContactMode::push) out.flags |= ForceSnapshot::pushes_only;
  return out;
}

}  // namespace rhexis::response
