#pragma once

/// Material constants as the models read them, and the small-strain correspondence between them (section 6.1 of the
/// paper): mu = 2 (c1 + c2), c1 + c2 = E / (4 (1 + nu)), kappa = E / (3 (1 - 2 nu)).

namespace rhexis::material {

/// Isotropic linear elasticity.
struct Elastic {
  double young = 0.0;    ///< E, Pa
  double poisson = 0.0;  ///< nu, in (-1, 0.5)

  [[nodiscard]] double lame_lambda() const { return young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson)); }
  [[nodiscard]] double lame_mu() const { return young / (2.0 * (1.0 + poisson)); }
};

/// W = c1 (I1bar - 3) + c2 (I2bar - 3) and the bulk modulus kappa. Neo-Hookean: c2 = 0.
struct MooneyRivlin {
  double c1 = 0.0;     ///< Pa
  double c2 = 0.0;     ///< Pa
  double kappa = 0.0;  ///< Pa

  [[nodiscard]] double shear_modulus() const { return 2.0 * (c1 + c2); }
};

/// c1 : c2 = 1 : 1 as in the paper, or c2 = 0 with `neo_hookean`.
[[nodiscard]] MooneyRivlin to_mooney_rivlin(const Elastic& elastic, bool neo_hookean = false);
[[nodiscard]] Elastic to_elastic(const MooneyRivlin& law);

}  // namespace rhexis::material
