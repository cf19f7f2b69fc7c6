#include "model/evaluation.h"

#include <algorithm>
#include <array>
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

TetFields make_tet_fields(std::size_t tets) {
  TetFields out;
  out.J.resize(tets);
  out.lambda.resize(tets);
  out.stress.resize(6 * tets);
  return out;
}

void set_tet(TetFields& fields, std::size_t tet, double J, double lambda, const Mat3& cauchy) {
  fields.J[tet] = J;
  fields.lambda[tet] = lambda;
  const std::array<double, 6> components{cauchy(0, 0), cauchy(1, 1), cauchy(2, 2),
                                         cauchy(0, 1), cauchy(1, 2), cauchy(0, 2)};
  std::copy(components.begin(), components.end(), fields.stress.begin() + static_cast<std::ptrdiff_t>(6 * tet));
}

}  // namespace rhexis::model
