#include "material/parameters.h"

namespace rhexis::material {

MooneyRivlin to_mooney_rivlin(const Elastic& elastic, bool neo_hookean) {
  const double sum = elastic.young / (4.0 * (1.0 + elastic.poisson));
  const double kappa = elastic.young / (3.0 * (1.0 - 2.0 * elastic.poisson));
  return neo_hookean ? MooneyRivlin{sum, 0.0, kappa} : MooneyRivlin{0.5 * sum, 0.5 * sum, kappa};
}

Elastic to_elastic(const MooneyRivlin& law) {
  const double mu = law.shear_modulus();
  return {9.0 * law.kappa * mu / (3.0 * law.kappa + mu), (3.0 * law.kappa - 2.0 * mu) / (2.0 * (3.0 * law.kappa + mu))};
}

}  // namespace rhexis::material
