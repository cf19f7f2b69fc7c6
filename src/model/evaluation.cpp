#include "model/evaluation.h"

#include <cmath>

namespace rhexis::model {

Evaluation evaluation_of(const VectorX& J) {
  Evaluation out;
  for (Eigen::Index t = 0; t < J.size(); ++t) {
    if (!std::isfinite(J[t])) {
      out.finite = false;
      out.worst_tet = TetId(static_cast<std::size_t>(t));
      out.min_J = J[t];
      return out;
    }
    if (J[t] <= 0.0) ++out.inverted_tets;
    if (!out.worst_tet.valid() || J[t] < out.min_J) {
      out.worst_tet = TetId(static_cast<std::size_t>(t));
      out.min_J = J[t];
    }
  }
  return out;
}

}  // namespace rhexis::model
