#pragma once

/// The compliance at held grasp points between recorded topologies: (4.27), for a linear body and any contact.

#include <optional>
#include <span>

#include <Eigen/Core>

#include "base/ids.h"
#include "record/store/loaded_record.h"
#include "record/store/reaction.h"

namespace rhexis::response {

struct RecordedContact {
  Eigen::MatrixXd compliance;  ///< m/N, 3 per node squared: symmetric positive definite
  bool torn_off = false;       ///< a node is out of the solve in a topology that counts
};

/// What (4.27) interpolates is the stiffness at a vertex, (L_ii)^-1. Between the vertices of a triangle the stiffness
/// condensed onto them, (L_cc)^-1, is interpolated the same way and inverted; each vertex is then scaled by a
/// congruence so that its own block is the inverse of what (4.27) gives it alone: the thesis's rule for a point inside
/// a triangle, which displaces one vertex at a time, is (4.27) to the letter. A vertex that is out of the solve in a
/// topology has no stiffness there; where that leaves it none at all, the last advances do not count.
///
/// Empty: some node is no grasp point, two of them share no edge of the intact surface, or one is in the solve nowhere.
[[nodiscard]] std::optional<RecordedContact> recorded_contact(const record::store::LoadedRecord& record,
                                                              const record::store::Lookup& lookup,
                                                              std::span<const record::store::Advanced> advances,
                                                              std::span<const NodeId> nodes);

}  // namespace rhexis::response
