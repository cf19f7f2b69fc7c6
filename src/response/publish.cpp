#include "response/publish.h"

namespace rhexis::response {

ForceSnapshot make_snapshot(const ContactLaw& law, const Publication& of) {
  ForceSnapshot out;
  for (int i = 0; i < 3; ++i) {
    const auto at = static_cast<std::size_t>(i);
    out.rest[at] = law.rest[i];
    out.start[at] = of.start[i];
    out.normal[at] = law.normal[i];
    for (int j = 0; j < 3; ++j) out.stiffness[3 * at + static_cast<std::size_t>(j)] = law.stiffness(i, j);
  }
  out.force_limit = of.force_limit;
  out.topology = of.topology;
  out.number = of.number;
  out.grasp = of.grasp;
  out.flags = ForceSnapshot::is_held;
  if (law.mode == ContactMode::push) out.flags |= ForceSnapshot::pushes_only;
  return out;
}

}  // namespace rhexis::response
