#pragma once

/// What the haptic loop needs to know of the body between two publications: the force law of the point that is held,
/// fixed in size, copied as bytes, evaluated without memory and in a time that does not depend on the body. The one
/// header of this room that the haptic loop reads.

#include <array>
#include <cstdint>
#include <type_traits>

#include "base/vec.h"

namespace rhexis::response {

struct ForceSnapshot {
  enum Flag : std::uint32_t {
    is_held = 1,      ///< a point is held: without it the force is zero
    pushes_only = 2,  ///< only against the outward normal
    torn_off = 8,     ///< the point that was held is on a piece without support, or gone
  };

  std::array<double, 9> stiffness{};  ///< N/m, by rows: force on the body for a displacement beyond `rest`
  std::array<double, 3> rest{};       ///< m, displacement of the point by the loads alone
  std::array<double, 3> start{};      ///< m, the same when the hand took hold: its own displacement counts from there
  std::array<double, 3> normal{};     ///< outward, unit
  double force_limit = 0.0;           ///< N, on the length of the force; 0: none
  std::uint64_t topology = 0;         ///< number of edits that the body had taken
  std::uint64_t number = 0;           ///< counts publications from 1, so that a recording can name them; 0: none yet
  std::uint32_t flags = 0;
  std::uint32_t grasp = 0;  ///< counts the times that the hand took hold: another number, another hold
};
static_assert(std::is_trivially_copyable_v<ForceSnapshot> && std::is_standard_layout_v<ForceSnapshot>);

struct Felt {
  Vec3 force = Vec3::Zero();  ///< N, of the hand on the body; the hand feels the opposite
  bool limited = false;       ///< cut to force_limit, in its direction
};

/// For a displacement (m) of the hand from the point's reference position. Zero for a displacement that is not finite.
[[nodiscard]] Felt force_at(const ForceSnapshot& snapshot, const Vec3& hand) noexcept;

}  // namespace rhexis::response
