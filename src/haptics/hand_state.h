#pragma once

/// What the physics reads of the hand: whom it holds for, by how much it is to move the body, and what it feels.

#include <array>
#include <cstdint>
#include <type_traits>

namespace rhexis::haptics {

struct HandState {
  enum Flag : std::uint32_t {
    present = 1,       ///< the device is there
    holds = 2,         ///< has taken hold for `grasp`; without it `hand` is the last, and not to be followed
    in_contact = 4,    ///< the body pushes back
    limited = 8,       ///< the device is given less than the body's force, for it can give no more
    faded = 16,        ///< less, for the physics is late
    lost = 32,         ///< nothing, for no law has come for so long that the physics counts as lost
    restrained = 64,   ///< damped or softened, lest the loop give energy out
    in_trouble = 128,  ///< nothing, for the position or the law was not a number
  };

  std::uint64_t tick = 0;              ///< of the haptic loop, 1 ms each
  std::uint64_t number = 0;            ///< of the snapshot in force
  std::uint32_t grasp = 0;             ///< of the hold that `hand` belongs to
  std::uint32_t flags = 0;             ///< of Flag
  std::array<double, 3> hand{};        ///< m, of the virtual hand from where it took hold: by this the body is moved
  std::array<double, 3> device{};      ///< m, of the device from where it took hold, in the measure of the scene
  std::array<double, 3> force{};       ///< N, on the hand, as the device is given it
  std::array<double, 3> body_force{};  ///< N, on the hand, of the body itself: before scale, fading and damping
};
static_assert(std::is_trivially_copyable_v<HandState>);

}  // namespace rhexis::haptics
