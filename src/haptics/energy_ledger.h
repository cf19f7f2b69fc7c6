#pragma once

/// Passivity observer and controller in the time domain (Hannaford and Ryu, 2002), with the energy that is stored taken
/// into account. The loop is a store, V = gain * energy of the law, that a hand fills and empties:
///
///     balance = what the hand has put in - what it was given - V - what a changed body has put into V
///
/// is what the loop has lost for good. Below zero energy has come from nowhere: from sampling, delay or quantisation.
/// It is taken back by damping, and what damping cannot take back at once by giving away a part of the store (a smaller
/// gain). A gain rises, and a body that stores more than before (a tear taken back) is felt, as far as the balance
/// pays for it. A tear that empties the store is the body's: it neither costs nor pays.

#include <algorithm>

namespace rhexis::haptics {

class EnergyLedger {
 public:
  /// `restrains`: false only watches, and every gain is had for nothing.
  EnergyLedger(double reserve, bool restrains) : reserve_(reserve), restrains_(restrains) {}

  /// A new hold: gain zero, nothing stored.
  void restart() noexcept { *this = EnergyLedger(reserve_, restrains_); }

  /// The device has moved: it was given `out` (J), and the store would hold `before` and `after` (J) at gain one.
  void moved(double out, double before, double after) noexcept {
    given_ += out;
    credit(-out - gain_ * (after - before));
  }
  /// The law is another one, at the same place.
  void law_changed(double before, double after) noexcept;
  /// Towards `target`, by no more than `rise` upwards. `energy` (J): of the law here.
  void move_gain(double target, double rise, double energy) noexcept;
  /// The store has given energy away by slipping.
  void slipped(double energy) noexcept { credit(gain_ * energy); }
  /// What is missing beyond `recoverable` (J) is paid by the gain.
  void settle(double recoverable, double energy) noexcept;

  [[nodiscard]] double gain() const { return gain_; }
  [[nodiscard]] double balance() const { return balance_; }                  ///< J
  [[nodiscard]] double missing() const { return std::max(0.0, -balance_); }  ///< J
  [[nodiscard]] double given() const { return given_; }  ///< J, to the hand since it took hold, less what it put in

 private:
  void credit(double energy) noexcept { balance_ = std::min(reserve_, balance_ + energy); }

  double reserve_;
  bool restrains_;
  double gain_ = 0.0;  ///< of the elastic force, in [0, 1]
  double balance_ = 0.0;
  double given_ = 0.0;
};

}  // namespace rhexis::haptics
