#include "model/stabilisation.h"

#include <cmath>

namespace rhexis::model {

double auto_beta(const mesh::TetMesh&, const material::MooneyRivlin& law) {
  // The jump term relative to the elastic one scales as beta / kappa against h / mu.
  return 0.3 * law.kappa / law.shear_modulus();
}

double smoothing_length(const mesh::TetMesh& mesh, double beta) {
  double weighted = 0.0, volume = 0.0;
  for (std::size_t t = 0; t < mesh.tet_count(); ++t) {
    const double v = mesh::signed_volume(mesh, TetId(t));
    weighted += v * mesh::longest_edge(mesh, TetId(t));
    volume += v;
  }
  return volume > 0.0 ? std::sqrt(beta) * weighted / volume : 0.0;
}

}  // namespace rhexis::model
