#pragma once

/// What clients get to see of an interaction, as frames of the wire.

#include <cstdint>
#include <vector>

#include "haptics/hand_state.h"
#include "session/interaction.h"
#include "session/surface_values.h"
#include "wire/frame.h"

namespace rhexis::session {

class FrameMaker {
 public:
  /// The body as it stands; begins an epoch.
  [[nodiscard]] wire::BodyT body(const Interaction& interaction);
  /// Of the last advance.
  [[nodiscard]] wire::EditT edit(const Interaction& interaction, const SurfaceChange& change);
  /// The body and the hand at this moment. What the loops and the recording say of themselves is left to the caller.
  [[nodiscard]] wire::StateT state(const Interaction& interaction, const haptics::HandState& hand);

  void show(wire::Field field) { field_ = field; }

 private:
  wire::Field field_ = wire::Field::none;
  std::uint32_t epoch_ = 0;
  SurfaceValues values_;
  [[nodiscard]] const VectorX& displacement(TearSession& tear);

  response::ForceBasis basis_;  ///< of the present topology; the picture's own, so that it has no part in the bits of
                                ///< the physics
  std::vector<NodeId> held_;    ///< that it is for
  VectorX u_;                   ///< m, of every node
};

}  // namespace rhexis::session
