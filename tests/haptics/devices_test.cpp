#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "haptics/device_list.h"
#include "haptics/pointer_device.h"
#include "haptics/script_device.h"
#include "tests/haptics/laws.h"

namespace rhexis::haptics::test {
namespace {

using testing::HasSubstr;

/// Two holds: the second begins at tick 3 where the first has ended, and ends with tick 5.
class TwoHolds final : public HandPath {
 public:
  HandPlace at(std::uint64_t tick) noexcept override {
    if (tick == 0 || tick > 5) return {};
    const std::uint32_t hold = tick < 3 ? 1 : 2;
    return {.position = Vec3(0.001, 0.0, 0.0) * static_cast<double>(tick - (hold == 1 ? 0 : 2)), .hold = hold};
  }
};

TEST(Motion, GoesThroughTheSamePlacesAsTear) {
  Motion motion(
      {{.by = Vec3(-0.12, 0.0, 0.0), .seconds = 0.2, .hold = 0.05}, {.by = Vec3(0.0, 0.01, 0.0), .seconds = 0.1}});
  EXPECT_EQ(motion.ticks(), 350u);
  EXPECT_EQ(motion.at(0).position, Vec3(0.0, 0.0, 0.0));
  for (int k = 1; k <= 250; ++k) {
    const auto tick = static_cast<std::uint64_t>(k);
    EXPECT_EQ(motion.at(tick).position, Vec3(-0.12, 0.0, 0.0) * (static_cast<double>(std::min(k, 200)) / 200));
    EXPECT_EQ(motion.at(tick).hold, 1u);
  }
  EXPECT_EQ(motion.at(251).position, Vec3(-0.12, 0.01 * (1.0 / 100), 0.0));
  EXPECT_EQ(motion.at(350).position, Vec3(-0.12, 0.01, 0.0));
  EXPECT_EQ(motion.at(350).hold, 1u);
  EXPECT_EQ(motion.at(9999).position, Vec3(-0.12, 0.01, 0.0));
  EXPECT_EQ(motion.at(9999).hold, 0u);
  EXPECT_EQ(Motion().at(5).position, Vec3(0.0, 0.0, 0.0));
  EXPECT_EQ(Motion().at(5).hold, 0u);
}

TEST(ScriptDevice, IsWhereTheScriptHasItAndGoneWhileThatHoldsNothing) {
  ScriptDevice device(std::make_shared<TwoHolds>());
  EXPECT_FALSE(device.read(0).present);
  EXPECT_TRUE(device.read(1).present);
  EXPECT_EQ(device.read(2).position, Vec3(0.002, 0.0, 0.0));
  EXPECT_EQ(device.read(3).position, Vec3(0.001, 0.0, 0.0)) << "counts from the hold";
  EXPECT_FALSE(device.read(6).present);
}

TEST(PointerDevice, IsWhereItWasLastMovedTo) {
  PointerDevice device;
  EXPECT_TRUE(device.read(0).present);
  EXPECT_TRUE(device.read(0).position.isZero(0.0));
  device.move_to(Vec3(0.01, 0.0, 0.0));
  device.move_to(Vec3(0.02, 0.0, 0.0), 1);
  EXPECT_EQ(device.read(1).position, Vec3(0.02, 0.0, 0.0));
  EXPECT_EQ(device.read(2).position, Vec3(0.02, 0.0, 0.0));
  EXPECT_EQ(device.read(2).buttons, 1u);
}

TEST(EmulatorDevice, AMassUnderAForceMovesAsItShould) {
  EmulatorSettings settings;
  settings.mass = 0.2;
  settings.damping = settings.hand_stiffness = settings.hand_damping = settings.resolution = 0.0;
  EmulatorDevice device(settings, at_rest());
  EXPECT_FALSE(device.read(0).present) << "not open yet";
  ASSERT_TRUE(device.open());
  for (std::uint64_t tick = 0; tick < 100; ++tick) {
    device.read(tick);
    device.write(Vec3(0.5, 0.0, 0.0));
  }
  const Vec3 moved = device.read(100).position;
  EXPECT_NEAR(moved[0], 0.5 * (0.5 / 0.2) * 0.1 * 0.1, 1e-14);  // a t^2 / 2, exact but for a hundred roundings
  EXPECT_NEAR(device.taken(), 0.5 * moved[0], 1e-14);
  EXPECT_NEAR(device.taken(), 0.5 * 0.2 * device.velocity().squaredNorm(), 1e-14);
}

TEST(EmulatorDevice, SwingsAsADampedOscillator) {
  EmulatorSettings settings;
  settings.mass = 0.1;
  settings.damping = settings.hand_damping = 0.5;
  settings.hand_stiffness = 90.0;
  settings.resolution = 0.0;
  settings.start = Vec3(0.01, 0.0, 0.0);
  EmulatorDevice device(settings, at_rest());
  ASSERT_TRUE(device.open());
  const double rate = (0.5 + 0.5) / (2.0 * 0.1);
  const double turn = std::sqrt(90.0 / 0.1 - rate * rate);
  for (std::uint64_t tick = 0; tick < 500; ++tick) {
    const double t = 1e-3 * static_cast<double>(tick);
    const double expected = 0.01 * std::exp(-rate * t) * (std::cos(turn * t) + rate / turn * std::sin(turn * t));
    ASSERT_NEAR(device.read(tick).position[0], expected, 1e-14);
  }
}

TEST(EmulatorDevice, FollowsItsHandForcesComeLateAndAreCutPositionsAreSteps) {
  EmulatorSettings settings;
  settings.delay = 5;
  EmulatorDevice device(settings, moving({{.by = Vec3(0.02, 0.0, 0.0), .seconds = 0.1}}));
  EXPECT_EQ(device.traits().delay, 5);
  ASSERT_TRUE(device.open());
  for (std::uint64_t tick = 0; tick < 1500; ++tick) {
    const double steps = device.read(tick).position[0] / settings.resolution;
    EXPECT_NEAR(steps, std::round(steps), 1e-9);
  }
  EXPECT_NEAR(device.position()[0], 0.02, 1e-4);
  device.write(Vec3(0.0, 1e6, 0.0));  // in tick 1499
  for (std::uint64_t tick = 1500; tick <= 1504; ++tick) {
    device.read(tick);
    EXPECT_EQ(device.position()[1], 0.0) << tick;
  }
  device.read(1505);
  EXPECT_GT(device.position()[1], 0.0);
  EXPECT_LT(device.position()[1], 1.01 * 8.9 / (2.0 * settings.mass) * 1e-6);
  device.read(1600);
  EXPECT_LT(std::abs(device.position()[1]), 2e-3) << "of one tick alone";
}

TEST(EmulatorDevice, ItsHandBeginsANewHoldWhereTheLastHasEndedAndStaysWhereItIs) {
  EmulatorSettings settings = EmulatorSettings::firmly_held();
  settings.resolution = 0.0;
  EmulatorDevice device(settings, std::make_shared<TwoHolds>());
  ASSERT_TRUE(device.open());
  device.read(3000);
  EXPECT_NEAR(device.position()[0], 0.002 + 0.003, 1e-12);  // at rest: e^(-50 t) and faster, for 3 s
  ASSERT_TRUE(device.open()) << "a loop that begins anew counts from 0 again";
  EXPECT_TRUE(device.read(0).position.isZero(0.0));
  device.read(3000);
  EXPECT_NEAR(device.position()[0], 0.002 + 0.003, 1e-12);
}

TEST(EmulatorDevice, ThatCannotBeIsRefused) {
  const auto refused = [](auto&& change) {
    EmulatorSettings settings;
    change(settings);
    return !EmulatorDevice(settings, at_rest()).open();
  };
  EXPECT_FALSE(refused([](EmulatorSettings&) {}));
  EXPECT_TRUE(refused([](EmulatorSettings& s) { s.mass = 0.0; }));
  EXPECT_TRUE(refused([](EmulatorSettings& s) { s.mass = std::numeric_limits<double>::quiet_NaN(); }));
  EXPECT_TRUE(refused([](EmulatorSettings& s) { s.hand_stiffness = -1.0; }));
  EXPECT_TRUE(refused([](EmulatorSettings& s) { s.delay = kMostDelay + 1; }));
  EXPECT_TRUE(refused([](EmulatorSettings& s) { s.resolution = -1e-5; }));
}

TEST(DeviceList, AllThatAreListedCanBeMade) {
  std::set<std::string> names;
  for (const DeviceTraits& traits : known_devices()) {
    EXPECT_TRUE(names.insert(traits.name).second);
    EXPECT_FALSE(traits.what.empty());
    const Expected<std::unique_ptr<Device>> device =
        make_device(traits.name, {.hand = moving({{.seconds = 0.01}}), .emulator = {}});
    ASSERT_TRUE(device) << device.error().message();
    EXPECT_EQ((*device)->traits().name, traits.name);
    ASSERT_TRUE((*device)->open());
    EXPECT_TRUE((*device)->read(0).present);
    EXPECT_TRUE(check_settings(settings_for((*device)->traits())));
    EXPECT_EQ(settings_for((*device)->traits()).is_rigid(), traits.max_force == 0.0);
  }
  EXPECT_EQ(names, (std::set<std::string>{"emulator", "pointer", "script"}));
}

TEST(DeviceList, WhatIsNotThereIsSaidWithWhatIs) {
  EXPECT_THAT(make_device("pointr", {}).error().message(), HasSubstr("did you mean 'pointer'?"));
  EXPECT_THAT(make_device("falcon-9", {}).error().message(), HasSubstr("one of pointer, script"));
  EXPECT_THAT(make_device("script", {}).error().message(), HasSubstr("no hand"));
  EXPECT_THAT(make_device("emulator", {}).error().message(), HasSubstr("no hand"));
}

}  // namespace
}  // namespace rhexis::haptics::test
