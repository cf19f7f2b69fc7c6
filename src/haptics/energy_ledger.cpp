#include "haptics/energy_ledger.h"

namespace rhexis::haptics {

void EnergyLedger::law_changed(double before, double after) noexcept {
  const double price = gain_ * (after - before);
  if (price <= 0.0) return;
  if (!restrains_ || price <= balance_) {
    balance_ -= price;
    return;
  }
  const double has = std::max(0.0, balance_);
  gain_ = (gain_ * before + has) / after;
  balance_ -= has;
}

void EnergyLedger::move_gain(double target, double rise, double energy) noexcept {
  double next = std::min(target, gain_ + rise);
  if (restrains_ && next > gain_ && energy > 0.0) next = std::min(next, gain_ + std::max(0.0, balance_) / energy);
  credit((gain_ - next) * energy);
  gain_ = next;
}

void EnergyLedger::settle(double recoverable, double energy) noexcept {
  const double due = missing() - recoverable;
  if (!restrains_ || due <= 0.0) return;
  const double worth = gain_ * energy;
  if (worth <= due) {
    credit(worth);
    gain_ = 0.0;
  } else {
    credit(due);
    gain_ -= due / energy;
  }
}

}  // namespace rhexis::haptics
