#pragma once

/// One tick of the haptic loop, as a function: the device's reading and the newest law in, the force and the hand out.
/// It knows no clock, takes no memory, throws nothing: the same readings with the same laws taken up in the same ticks
/// give the same bits.

#include <array>
#include <cstdint>
#include <optional>

#include "haptics/coupling.h"
#include "haptics/device.h"
#include "haptics/energy_ledger.h"
#include "haptics/hand_state.h"
#include "haptics/position_filter.h"
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

  void take_up(const response::ForceSnapshot& snapshot) noexcept;
  void follow_device(const Vec3& position) noexcept;
  void change_phase(bool device_is_there) noexcept;
  void take_hold() noexcept;
  void follow_law() noexcept;
  void evaluate() noexcept;
  void close_grip() noexcept;
  void move_presence(bool nothing_is_wrong) noexcept;
  void find_force() noexcept;
  [[nodiscard]] Vec3 acting_force() const noexcept;
  [[nodiscard]] Vec3 damping_force() const noexcept;
  [[nodiscard]] bool is_held_by(std::uint32_t grasp) const noexcept;
  [[nodiscard]] double fading() const noexcept;
  [[nodiscard]] double limit_now() const noexcept;
  [[nodiscard]] FeltLaw newest_law() const noexcept;
  [[nodiscard]] HandState hand_state(const Reading& reading) const noexcept;

  TickSettings settings_;
  double device_limit_;    ///< N, of settings and device; infinite: none
  bool counts_from_hold_;  ///< as DeviceTraits
  std::uint64_t delay_;    ///< as DeviceTraits
  double smoothing_;       ///< of the velocity: the part that a new value has
  std::uint64_t tick_ = 0;

  response::ForceSnapshot newest_;   ///< the last that could be read
  bool newest_is_readable_ = false;  ///< the last that came could be
  std::uint64_t number_ = 0;         ///< of the last that came
  std::uint32_t law_age_ = 0;        ///< ticks since one came

  PositionFilter filter_;
  std::optional<Vec3> seen_;      ///< m, `position_` through the filter
  std::optional<Vec3> position_;  ///< m, of the device, when it was last there
  bool was_there_ = false;        ///< in the last tick
  double trend_ = 0.0;  ///< m^2/s, low-passed velocity_ times the next motion: below zero no damper takes energy
  Vec3 velocity_ = Vec3::Zero();  ///< m/s, of the device, low-passed

  Phase phase_ = Phase::idle;
  std::uint32_t grasp_ = 0;    ///< of the hold
  int held_ticks_ = 0;         ///< up to settings_.ramp_ticks
  Vec3 zero_ = Vec3::Zero();   ///< m, position of the device where it took hold
  Vec3 at_ = Vec3::Zero();     ///< m, of the device from there
  FeltLaw law_;                ///< in force
  double limit_ = 0.0;         ///< N, in force
  Vec3 aside_ = Vec3::Zero();  ///< m, from at_ to where the filter sees the device: for the energy
  double stored_ = 0.0;        ///< J, at at_ + aside_, by law_ and limit_
  Coupled coupled_;            ///< at at_, by these
  double presence_ = 0.0;      ///< in [0, 1], of all force: taking hold, letting go, late laws
  EnergyLedger ledger_;
  Vec3 force_ = Vec3::Zero();                 ///< N, on the hand
  std::array<Vec3, kMostDelay + 1> written_;  ///< those of the last ticks, by tick
  bool is_clipped_ = false;                   ///< that was to be longer
};

}  // namespace rhexis::haptics
