#pragma once

/// One tick of the haptic loop, as a function: the device's reading and the newest law in, the force and the hand out.
/// It knows no clock, takes no memory, throws nothing: the same readings with the same laws taken up in the same ticks
/// give the same bits.

#include <cstdint>
#include <optional>

#include "haptics/coupling.h"
#include "haptics/device.h"
#include "haptics/energy_ledger.h"
#include "haptics/hand_state.h"
#include "haptics/tick_settings.h"
#include "response/snapshot.h"

namespace rhexis::haptics {

struct TickOutput {
  Vec3 force = Vec3::Zero();  ///< N, on the hand: for the device
  HandState hand;
  std::uint32_t law_age = 0;  ///< ticks since a law was taken up
  double given = 0.0;         ///< J, to the hand since it took hold, less what it put in
  double balance = 0.0;       ///< J, of EnergyLedger
  double gain = 0.0;          ///< of the elastic force, in [0, 1]
};

class HapticTick {
 public:
  /// The settings have to pass check_settings().
  explicit HapticTick(const TickSettings& settings, const DeviceTraits& traits);

  /// Ticks count from 0, kTickSeconds each. `fresh`: the law has been taken up since the last tick; else it is the one
  /// of the last tick again.
  TickOutput step(const Reading& reading, const response::ForceSnapshot& law, bool fresh) noexcept;

 private:
  enum class Phase { idle, holding, releasing };

  void take_up(const response::ForceSnapshot& snapshot, bool readable) noexcept;
  void take_hold(const Vec3& position) noexcept;
  void follow_device(const Vec3& position) noexcept;
  void follow_law() noexcept;
  void close_grip() noexcept;
  void move_gain() noexcept;
  [[nodiscard]] double fading() const noexcept;
  [[nodiscard]] double limit() const noexcept;
  [[nodiscard]] Vec3 damped() noexcept;
  [[nodiscard]] TickOutput output(std::uint32_t flags) const noexcept;
  void drop() noexcept;

  TickSettings settings_;
  double device_limit_;    ///< N, of settings and device; infinite: none
  bool counts_from_hold_;  ///< as DeviceTraits
  double smoothing_;       ///< of the velocity: part of the new value in each tick
  std::uint64_t tick_ = 0;
  std::uint32_t law_age_ = 0;         ///< ticks since a law was taken up
  std::uint32_t up_to_date_age_ = 0;  ///< ticks since one was that is not out of date
  bool law_is_readable_ = false;

  Phase phase_ = Phase::idle;
  std::uint32_t grasp_ = 0;  ///< of the hold
  std::uint32_t held_ticks_ = 0;
  std::uint64_t number_ = 0;        ///< of the newest snapshot
  response::ForceSnapshot newest_;  ///< the last that could be read
  FeltLaw law_;                     ///< in force: of `grasp_`
  double scene_limit_ = 0.0;        ///< N, of the law in force; 0: none

  std::optional<Vec3> last_position_;  ///< m, as the device gave it
  Vec3 zero_ = Vec3::Zero();           ///< m, where the device took hold
  Vec3 at_ = Vec3::Zero();             ///< m, of the device from `zero_`
  Vec3 velocity_ = Vec3::Zero();       ///< m/s, low-passed
  Coupled coupled_;                    ///< at `at_`, by the law in force
  Vec3 force_ = Vec3::Zero();          ///< N, on the hand, of this tick
  double presence_ = 0.0;              ///< in [0, 1]: of all force, by taking hold, letting go, and late laws
  EnergyLedger ledger_;
};

}  // namespace rhexis::haptics
