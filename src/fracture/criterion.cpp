#include "fracture/criterion.h"

#include <cmath>
#include <string>
#include <vector>

#include "base/nearest_name.h"
#include "fracture/criterion_one_tet.h"
#include "fracture/maximum_hoop.h"

namespace rhexis::fracture {

Expected<std::unique_ptr<Criterion>> make_criterion(std::string_view name, const CriterionSettings& settings) {
  if (!(settings.strength > 0.0)) return fail("the strength is not positive");
  if (!(settings.mean_edge > 0.0)) return fail("the mean edge length is not positive");
  if (!(settings.advance_threshold > 0.0 && settings.advance_threshold <= settings.strength))
    return fail("the advance threshold is not between 0 and the strength");
  if (auto criterion = make_one_tet_criterion(name, settings)) return criterion;
  if (name == "maximum-hoop") return std::make_unique<MaximumHoop>(settings);
  const std::string near = nearest_name(name, std::vector<std::string>(kCriterionNames.begin(), kCriterionNames.end()));
  return fail(fmt::format("unknown criterion '{}'", name),
              near.empty() ? std::string("\"maximum-principal\", \"maximum-shear\", \"von-mises\" or \"maximum-hoop\"")
                           : fmt::format("did you mean '{}'?", near));
}

Judgement by_toughness(const Judgement& judgement, double energy_release, double toughness, double mean_edge) {
  Judgement out = judgement;
  out.met = judgement.value > 0.0 && std::isfinite(energy_release) && energy_release >= toughness;
  out.length = mean_edge;
  return out;
}

}  // namespace rhexis::fracture
