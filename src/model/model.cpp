#include "model/model.h"

#include "base/check.h"

namespace rhexis::model {

Evaluation Model::tet_tangents(const State&, Scratch&, std::vector<double>&, std::vector<double>&) const {
  RHEXIS_CHECK(false, "{} is no sum over tets of one tangent each", name());
}

std::vector<double> Model::tet_volumes() const { RHEXIS_CHECK(false, "{} keeps no volumes", name()); }

TetState Model::tet_state(const State&, TetId, const Mat3&) const {
  RHEXIS_CHECK(false, "{} has no state of one tet by itself", name());
}

}  // namespace rhexis::model
