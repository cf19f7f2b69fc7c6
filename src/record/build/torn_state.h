#pragma once

/// A body on its way through the advances of a record: what a topology is before anything is solved. A value; a copy
/// goes its own way.

#include <vector>

#include "base/error.h"
#include "fracture/path_start.h"
#include "fracture/torn_body.h"
#include "record/store/record.h"
#include "response/elastic_elements.h"

namespace rhexis::record::build {

/// y as the crack points, z along `through`, as far as it is across the crack.
[[nodiscard]] store::Frame frame_of(const fracture::CrackLine& crack);

struct TornState {
  fracture::TornBody body;
  std::vector<fracture::Crack> cracks;
  std::uint8_t flags = 0;  ///< store::TopologyFlag of the last advance

  /// The body with its first crack cut. Errors as fracture::cut_initial.
  [[nodiscard]] static Expected<TornState> begin(const mesh::TetMesh& mesh, const response::ElasticBody& elastic,
                                                 const fracture::CrackLine& crack);
  /// Every front that still runs goes on by `length` (m) along `direction` (unit), whatever a criterion says. Where
  /// that meets nothing to cut, all stays as it is, and the flag says so.
  void advance(const Vec3& direction, double length);
};

}  // namespace rhexis::record::build
