#pragma once

/// What the tearing of one tick leaves on record.

#include <cstddef>
#include <optional>
#include <vector>

#include "base/vec.h"
#include "response/response.h"

namespace rhexis::session {

/// One crack has run on once (or has started): one topology change.
struct AdvanceRecord {
  std::size_t topology = 0;  ///< number of the topology that it made; the intact body is 0
  int tick = 0;              ///< in which it happened; 0 for a crack that was there from the start
  bool started = false;      ///< a crack of the scene, or a new one
  double length = 0.0;       ///< m
  double angle = 0.0;        ///< degrees, of the advance, from +x in the x-y plane
  double turn = 0.0;         ///< degrees, from the direction before
  double value = 0.0;        ///< Pa by strength; N/m by toughness: what met the criterion
  int edges_cut = 0;
  int tets_removed = 0;
  int tets_frozen = 0;
  int nodes_moved = 0;
  int nodes_copied = 0;
  double volume_lost = 0.0;                   ///< m^3
  int pieces = 1;                             ///< of the body after it
  bool finished = false;                      ///< the crack has left the body
  double crack_area = 0.0;                    ///< m^2, of all cracks after it
  Vec3 force_before = Vec3::Zero();           ///< N, on the hand
  Vec3 force_after = Vec3::Zero();            ///< N, on the hand at the same place
  std::optional<response::RecordUse> record;  ///< what answers from now on; empty: no record does
  std::vector<Vec3> front_before;             ///< m
  std::vector<Vec3> front_after;              ///< m, of all the fronts that it has become
  double remesh_seconds = 0.0;                ///< plan, incision, pieces
  double local_seconds = 0.0;                 ///< local objects: made and factored
  double update_seconds = 0.0;                ///< response, waiting included
  double wait_seconds = 0.0;                  ///< of that, for work in the background
};

}  // namespace rhexis::session
