#include "haptics/energy_ledger.h"

#include <gtest/gtest.h>

namespace rhexis::haptics {
namespace {

EnergyLedger holding() {
  EnergyLedger ledger(0.1, true);
  ledger.restart();
  ledger.move_gain(1.0, 1.0, 0.0);
  return ledger;
}

TEST(EnergyLedger, ASpringCostsNothingWhatIsDampedIsKept) {
  EnergyLedger ledger = holding();
  ledger.moved(-0.02, 0.0, 0.02);  // put in, and stored
  EXPECT_EQ(ledger.balance(), 0.0);
  ledger.moved(-0.005, 0.02, 0.02);  // put in, and gone
  EXPECT_DOUBLE_EQ(ledger.balance(), 0.005);
  EXPECT_DOUBLE_EQ(ledger.given(), -0.025);
}

TEST(EnergyLedger, NoMoreIsKeptThanTheReserve) {
  EnergyLedger ledger = holding();
  ledger.moved(-3.0, 0.0, 0.0);
  EXPECT_EQ(ledger.balance(), 0.1);
  ledger.moved(0.25, 0.0, 0.0);
  EXPECT_DOUBLE_EQ(ledger.missing(), 0.15);
}

TEST(EnergyLedger, ATearPaysNothing) {
  EnergyLedger ledger = holding();
  ledger.moved(-0.02, 0.0, 0.02);
  ledger.law_changed(0.02, 0.005);
  EXPECT_EQ(ledger.balance(), 0.0);
  EXPECT_EQ(ledger.gain(), 1.0);
}

TEST(EnergyLedger, ABodyThatStoresMoreIsFeltAsFarAsTheBalancePays) {
  EnergyLedger rich = holding();
  rich.moved(-0.05, 0.0, 0.02);
  rich.law_changed(0.02, 0.04);
  EXPECT_EQ(rich.gain(), 1.0);
  EXPECT_NEAR(rich.balance(), 0.01, 1e-17);

  EnergyLedger poor = holding();
  poor.moved(-0.025, 0.0, 0.02);
  poor.law_changed(0.02, 0.05);
  EXPECT_DOUBLE_EQ(poor.gain() * 0.05, 0.02 + 0.005);
  EXPECT_EQ(poor.balance(), 0.0);
  poor.move_gain(1.0, 0.1, 0.05);
  EXPECT_DOUBLE_EQ(poor.gain(), 0.5) << "nothing is there to pay for more";
  poor.move_gain(1.0, 0.1, 0.0);
  EXPECT_DOUBLE_EQ(poor.gain(), 0.6) << "where nothing is stored a gain costs nothing";
}

TEST(EnergyLedger, AFadingForceGivesItsEnergyToTheBalanceWhichPaysForItsReturn) {
  EnergyLedger ledger = holding();
  ledger.moved(-0.04, 0.0, 0.04);
  ledger.move_gain(0.25, 1.0, 0.04);
  EXPECT_DOUBLE_EQ(ledger.balance(), 0.03);
  ledger.move_gain(1.0, 1.0, 0.04);
  EXPECT_DOUBLE_EQ(ledger.gain(), 1.0);
  EXPECT_NEAR(ledger.balance(), 0.0, 1e-17);
}

TEST(EnergyLedger, TheGainPaysWhatDampingCannotTakeBack) {
  EnergyLedger ledger = holding();
  ledger.moved(-0.03, 0.0, 0.04);  // 0.01 J from nowhere
  ledger.settle(0.004, 0.04);
  EXPECT_NEAR(ledger.missing(), 0.004, 1e-17);
  EXPECT_DOUBLE_EQ(ledger.gain(), 1.0 - 0.006 / 0.04);
  ledger.settle(0.0, 0.001);  // more than is stored here
  EXPECT_EQ(ledger.gain(), 0.0);
  EXPECT_GT(ledger.missing(), 0.003);
}

TEST(EnergyLedger, OneThatOnlyWatchesHasEveryGain) {
  EnergyLedger ledger(0.1, false);
  ledger.move_gain(1.0, 1.0, 0.5);
  EXPECT_EQ(ledger.gain(), 1.0);
  EXPECT_EQ(ledger.missing(), 0.5);
  ledger.settle(0.0, 0.5);
  ledger.law_changed(0.5, 0.7);
  EXPECT_EQ(ledger.gain(), 1.0);
  EXPECT_DOUBLE_EQ(ledger.missing(), 0.7);
}

}  // namespace
}  // namespace rhexis::haptics
