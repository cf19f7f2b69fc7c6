#include "haptics/tick.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <vector>

#include "tests/haptics/laws.h"

namespace rhexis::haptics::test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

bool has(const TickOutput& out, HandState::Flag flag) { return (out.hand.flags & flag) != 0; }

/// A tick whose physics keeps its law up to date.
struct Loop {
  HapticTick tick;
  ForceSnapshot law;
  TickOutput last = {};

  TickOutput go(const Vec3& position) { return last = tick.step(at(position), law, true); }
  /// In a straight line, then still until nothing is damped any more.
  TickOutput go_to(const Vec3& from, const Vec3& to, int ticks) {
    for (int k = 1; k <= ticks; ++k) go(from + (to - from) * (static_cast<double>(k) / ticks));
    for (int k = 0; k < 100; ++k) go(to);
    return last;
  }
};

Loop strong_loop(const ForceSnapshot& law) { return {HapticTick(settings_for(strong_device()), strong_device()), law}; }
Loop pointing_loop(const ForceSnapshot& law) {
  return {HapticTick(settings_for(pointing_device()), pointing_device()), law};
}

TEST(HapticTick, FeelsTheBodyThroughTheCouplingOnceTheGripIsClosed) {
  std::mt19937_64 random(1);
  const Mat3 stiffness = random_stiffness(random);
  Loop loop = strong_loop(make_law(stiffness));
  const Vec3 start(0.3, -0.2, 0.1);
  const Vec3 moved(0.002, 0.001, -0.0015);
  for (int k = 0; k < 100; ++k) loop.go(start);
  EXPECT_TRUE(loop.last.force.isZero(0.0));
  const TickOutput out = loop.go_to(start, start + moved, 200);
  EXPECT_TRUE(has(out, HandState::holds));
  EXPECT_TRUE(has(out, HandState::in_contact));
  EXPECT_FALSE(has(out, HandState::limited));
  EXPECT_EQ(out.gain, 1.0) << "the damper has earned what sampling lost";
  const Mat3 series = (stiffness.inverse() + Mat3::Identity() / settings_for(strong_device()).stiffness).inverse();
  EXPECT_LT((out.force + series * moved).norm(), 1e-10 * out.force.norm());
  EXPECT_LT((vec(out.hand.body_force) - out.force).norm(), 1e-12 * out.force.norm());
  EXPECT_LT((stiffness * vec(out.hand.hand) + out.force).norm(), 1e-9 * out.force.norm()) << "the hand moves the body";
  EXPECT_LT((vec(out.hand.device) - moved).norm(), 1e-16);
}

TEST(HapticTick, AHandThatCannotFeelIsWhereItsDeviceIs) {
  std::mt19937_64 random(2);
  const Mat3 stiffness = random_stiffness(random);
  Loop loop = pointing_loop(make_law(stiffness));
  const Vec3 moved(0.03, -0.02, 0.04);
  loop.go(moved);  // it has moved on before the hold is known: its position counts from the hold
  EXPECT_EQ(vec(loop.last.hand.hand), moved);
  for (int k = 0; k < 50; ++k) loop.go(moved);
  EXPECT_EQ(vec(loop.last.hand.hand), moved);
  EXPECT_LT((loop.last.force + stiffness * moved).norm(), 1e-12 * loop.last.force.norm());
}

TEST(HapticTick, CountsFromWhereTheLoadsHadTakenThePoint) {
  ForceSnapshot law = make_law(200.0 * Mat3::Identity());
  law.start = {0.0, 0.0, -0.010};
  law.rest = {0.0, 0.0, -0.012};  // it has torn since
  Loop loop = pointing_loop(law);
  for (int k = 0; k < 60; ++k) loop.go(Vec3::Zero());
  EXPECT_NEAR(loop.last.force[2], -200.0 * 0.002, 1e-12);
}

TEST(HapticTick, ForceIsNothingInTheTickInWhichTheDeviceIsLost) {
  Loop loop = strong_loop(make_law(300.0 * Mat3::Identity()));
  loop.go_to(Vec3::Zero(), Vec3::Zero(), 1);
  const Vec3 there(0.01, 0.0, 0.0);
  EXPECT_GT(loop.go_to(Vec3::Zero(), there, 100).force.norm(), 1.0);
  Reading gone = at(there);
  gone.present = false;
  TickOutput out = loop.tick.step(gone, loop.law, true);
  EXPECT_TRUE(out.force.isZero(0.0));
  EXPECT_FALSE(has(out, HandState::present));
  EXPECT_TRUE(has(out, HandState::holds)) << "the physics decides about the hold";

  // It comes back somewhere else: the hand goes on from where it was, and the force is there again in a ramp.
  const Vec3 hand = vec(out.hand.hand);
  const Vec3 elsewhere(0.2, 0.1, 0.0);
  double before = 0.0;
  for (int k = 0; k < settings_for(strong_device()).ramp_ticks; ++k) {
    out = loop.go(elsewhere);
    EXPECT_LT((vec(out.hand.hand) - hand).norm(), 1e-15);
    EXPECT_GE(out.force.norm(), before - 1e-12);
    EXPECT_LT(out.force.norm() - before, 0.1);
    before = out.force.norm();
  }
  EXPECT_NEAR(out.force.norm(), 0.01 / (1.0 / 300.0 + 1.0 / settings_for(strong_device()).stiffness), 1e-9);
}

TEST(HapticTick, ForceIsNothingForWhatIsNotANumber) {
  for (const DeviceTraits& traits : {strong_device(), pointing_device()}) {
    Loop loop{HapticTick(settings_for(traits), traits), make_law(300.0 * Mat3::Identity())};
    loop.go(Vec3::Zero());
    const Vec3 there(0.01, 0.0, 0.0);
    EXPECT_GT(loop.go_to(Vec3::Zero(), there, 100).force.norm(), 1.0);
    for (const Vec3& bad : {Vec3(kNan, 0.0, 0.0), Vec3(0.0, 0.0, std::numeric_limits<double>::infinity())}) {
      const TickOutput out = loop.tick.step(at(bad), loop.law, true);
      EXPECT_TRUE(out.force.isZero(0.0));
      EXPECT_TRUE(has(out, HandState::in_trouble));
      EXPECT_TRUE(vec(out.hand.hand).allFinite());
      EXPECT_GT(loop.go_to(there, there, 1).force.norm(), 1.0) << "and is there again after it";
    }
    ForceSnapshot bad = loop.law;
    bad.stiffness[4] = kNan;
    const TickOutput out = loop.tick.step(at(there), bad, true);
    EXPECT_TRUE(out.force.isZero(0.0));
    EXPECT_TRUE(has(out, HandState::in_trouble));
    EXPECT_TRUE(loop.tick.step(at(there), bad, false).force.isZero(0.0)) << "until a law comes that is one";
    EXPECT_TRUE(vec(out.hand.hand).allFinite());
    EXPECT_GT(loop.go_to(there, there, 1).force.norm(), 1.0);
    bad = loop.law;
    bad.rest[1] = kNan;
    EXPECT_TRUE(loop.tick.step(at(there), bad, true).force.isZero(0.0));
  }
}

TEST(HapticTick, ALatePhysicsIsHeldThenFadesThenIsLost) {
  for (const DeviceTraits& traits : {strong_device(), pointing_device()}) {
    const TickSettings settings = settings_for(traits);
    Loop loop{HapticTick(settings, traits), make_law(300.0 * Mat3::Identity())};
    loop.go(Vec3::Zero());
    const Vec3 there(0.01, 0.0, 0.0);
    const double full = loop.go_to(Vec3::Zero(), there, 100).force.norm();
    double before = full;
    for (int age = 1; age <= settings.lost_ticks + 10; ++age) {
      const TickOutput out = loop.tick.step(at(there), loop.law, false);
      EXPECT_EQ(out.law_age, static_cast<std::uint32_t>(age));
      EXPECT_EQ(has(out, HandState::faded), age > settings.late_ticks);
      EXPECT_EQ(has(out, HandState::lost), age >= settings.lost_ticks);
      if (age <= settings.late_ticks) {
        EXPECT_NEAR(out.force.norm(), full, 1e-9 * full);
      } else {
        EXPECT_LE(out.force.norm(), before + 1e-12);
        EXPECT_LT(before - out.force.norm(), 1.1 * full / (settings.lost_ticks - settings.late_ticks));
      }
      if (age >= settings.lost_ticks) {
        EXPECT_TRUE(out.force.isZero(0.0));
      }
      before = out.force.norm();
    }
    for (int k = 0; k < settings.ramp_ticks; ++k) {
      const TickOutput out = loop.go(there);
      EXPECT_LT(out.force.norm() - before, 1.1 * full / settings.ramp_ticks) << "it comes back in a ramp";
      before = out.force.norm();
    }
    EXPECT_NEAR(before, full, 1e-9 * full) << "what faded pays for it";
  }
}

TEST(HapticTick, TheGripClosesInARampAndSlipsUntilThen) {
  Loop loop = strong_loop(make_law(800.0 * Mat3::Identity()));
  const TickSettings settings = settings_for(strong_device());
  loop.go(Vec3::Zero());
  for (int k = 1; k <= settings.ramp_ticks; ++k) {
    loop.go(Vec3(0.0004 * k, 0.0, 0.0));
    EXPECT_LE(loop.last.force.norm(), settings.max_force * k / settings.ramp_ticks * (1.0 + 1e-12));
  }
  EXPECT_GT(loop.last.force.norm(), 1.0);
  const double device = loop.last.hand.device[0];
  EXPECT_LT(device, 0.0004 * settings.ramp_ticks - 0.001) << "it has slipped";
  loop.go(Vec3(0.0004 * settings.ramp_ticks + 0.001, 0.0, 0.0));
  EXPECT_NEAR(loop.last.hand.device[0], device + 0.001, 2e-4) << "and holds";
}

TEST(HapticTick, LettingGoFadesInARampAndTheNextHoldBeginsAtItsOwnPlace) {
  Loop loop = strong_loop(make_law(300.0 * Mat3::Identity()));
  loop.go(Vec3::Zero());
  const Vec3 there(0.01, 0.0, 0.0);
  const double full = loop.go_to(Vec3::Zero(), there, 100).force.norm();
  loop.law = ForceSnapshot{};
  loop.law.number = 2;
  loop.law.grasp = 1;
  double before = full;
  const int ramp = settings_for(strong_device()).ramp_ticks;
  for (int k = 1; k <= ramp; ++k) {
    loop.go(there);
    EXPECT_FALSE(has(loop.last, HandState::holds));
    EXPECT_NEAR(before - loop.last.force.norm(), full / ramp, 1e-9 * full);
    before = loop.last.force.norm();
  }
  EXPECT_LT(loop.go(there).force.norm(), 1e-12);
  loop.law = make_law(300.0 * Mat3::Identity(), 2, 3);
  loop.go(there);
  EXPECT_EQ(loop.last.hand.grasp, 2u);
  EXPECT_TRUE(has(loop.last, HandState::holds));
  EXPECT_TRUE(vec(loop.last.hand.hand).isZero(0.0));
  loop.go_to(there, there, 100);
  EXPECT_TRUE(loop.last.force.isZero(0.0));
}

TEST(HapticTick, AnotherHoldWaitsUntilTheLastHasFaded) {
  Loop loop = strong_loop(make_law(300.0 * Mat3::Identity()));
  loop.go(Vec3::Zero());
  const Vec3 there(0.01, 0.0, 0.0);
  loop.go_to(Vec3::Zero(), there, 100);
  loop.law = make_law(500.0 * Mat3::Identity(), 2, 2);
  double before = loop.last.force.norm();
  int waited = 0;
  while (loop.go(there).hand.grasp == 1 && waited < 1000) {
    EXPECT_LT(before - loop.last.force.norm(), 0.1);
    before = loop.last.force.norm();
    ++waited;
  }
  EXPECT_EQ(waited, settings_for(strong_device()).ramp_ticks);
  EXPECT_TRUE(vec(loop.last.hand.hand).isZero(0.0));
}

TEST(HapticTick, APieceThatHasComeOffIsLetGo) {
  Loop loop = strong_loop(make_law(300.0 * Mat3::Identity()));
  loop.go(Vec3::Zero());
  loop.go_to(Vec3::Zero(), Vec3(0.01, 0.0, 0.0), 100);
  EXPECT_TRUE(has(loop.last, HandState::holds));
  loop.law.flags |= ForceSnapshot::torn_off;
  loop.go_to(Vec3(0.01, 0.0, 0.0), Vec3(0.01, 0.0, 0.0), 1);
  EXPECT_FALSE(has(loop.last, HandState::holds));
  EXPECT_LT(loop.last.force.norm(), 1e-12);
}

TEST(HapticTick, ForceHasALimitWhicheverIsTheSmallest) {
  std::mt19937_64 random(3);
  const struct {
    double settings, device, scene, all;
  } cases[] = {{5.0, 8.9, 0.0, 5.0}, {8.9, 3.0, 6.0, 3.0}, {8.9, 8.9, 2.0, 2.0}};
  for (const auto& one : cases) {
    DeviceTraits traits = strong_device();
    traits.max_force = one.device;
    TickSettings settings = settings_for(traits);
    settings.max_force = one.settings;
    for (int k = 0; k < 20; ++k) {
      ForceSnapshot law = make_law(random_stiffness(random));
      law.force_limit = one.scene;
      Loop loop{HapticTick(settings, traits), law};
      loop.go_to(Vec3::Zero(), Vec3::Zero(), 1);
      double most = 0.0;
      for (int t = 0; t < 300; ++t) {
        loop.go(0.001 * t * Vec3(1.0, 0.3, -0.5));
        most = std::max(most, loop.last.force.norm());
        EXPECT_LE(loop.last.force.norm(), one.all * (1.0 + 1e-12));
      }
      EXPECT_GT(most, 0.99 * one.all);
      EXPECT_TRUE(has(loop.last, HandState::limited));
    }
  }
}

TEST(HapticTick, ScalesMeanWhatTheySay) {
  const Mat3 stiffness = Vec3(400.0, 100.0, 900.0).asDiagonal();
  TickSettings settings = settings_for(strong_device());
  settings.motion_scale = 2.5;
  settings.force_scale = 0.1;
  Loop loop{HapticTick(settings, strong_device()), make_law(stiffness)};
  loop.go_to(Vec3::Zero(), Vec3::Zero(), 1);
  const Vec3 moved(0.02, 0.01, -0.01);
  const TickOutput out = loop.go_to(Vec3::Zero(), moved, 400);
  EXPECT_GT(out.force.norm(), 1.0);
  EXPECT_LT((vec(out.hand.device) - 2.5 * moved).norm(), 1e-15);
  EXPECT_LT((vec(out.hand.body_force) + stiffness * vec(out.hand.hand)).norm(), 1e-11);
  EXPECT_LT((out.force - 0.1 * vec(out.hand.body_force)).norm(), 1e-11);
  // The coupling is at the device.
  EXPECT_LT((settings.stiffness * (moved - vec(out.hand.hand) / 2.5) + out.force).norm(), 1e-10);
}

TEST(HapticTick, APushDoesNotStick) {
  Loop loop = strong_loop(make_push(600.0));
  loop.go_to(Vec3::Zero(), Vec3::Zero(), 1);
  loop.go_to(Vec3::Zero(), Vec3(0.0, 0.0, -0.005), 50);
  EXPECT_GT(loop.last.force[2], 1.0);
  for (int k = 0; k < 40; ++k) {  // drawn away fast: the damper would pull
    loop.go(Vec3(0.001 * k, 0.0, -0.005 + 0.0006 * k));
    EXPECT_GE(loop.last.force[2], 0.0);
    EXPECT_NEAR(loop.last.force[0], 0.0, 1e-12);
  }
  EXPECT_TRUE(loop.last.force.isZero(0.0));
  EXPECT_FALSE(has(loop.last, HandState::in_contact));
}

TEST(HapticTick, TheSameReadingsGiveTheSameBits) {
  const auto run = [] {
    std::mt19937_64 random(5);
    HapticTick tick(settings_for(strong_device()), strong_device());
    ForceSnapshot law;
    std::vector<HandState> out;
    Vec3 position = Vec3::Zero();
    for (int t = 0; t < 3000; ++t) {
      const bool fresh = t % 7 == 0;
      if (fresh) {
        law =
            make_law(random_stiffness(random), static_cast<std::uint32_t>(1 + t / 900), static_cast<std::uint64_t>(t));
        law.rest = {1e-3 * uniform(random), 0.0, 0.0};
      }
      position += 1e-4 * random_vector(random);
      Reading reading = at(position);
      reading.present = t % 500 != 250;
      out.push_back(tick.step(reading, law, fresh).hand);
    }
    return out;
  };
  const std::vector<HandState> one = run();
  const std::vector<HandState> other = run();
  EXPECT_EQ(std::memcmp(one.data(), other.data(), one.size() * sizeof(HandState)), 0);
  EXPECT_GT(vec(one.back().force).norm(), 0.0);
}

TEST(TickSettings, ThatContradictThemselvesAreRefused) {
  EXPECT_TRUE(check_settings(settings_for(strong_device())));
  EXPECT_TRUE(check_settings(settings_for(pointing_device())));
  const auto refused = [](auto&& change) {
    TickSettings settings = settings_for(strong_device());
    change(settings);
    return !check_settings(settings);
  };
  EXPECT_TRUE(refused([](TickSettings& s) { s.stiffness = 0.0; }));
  EXPECT_TRUE(refused([](TickSettings& s) { s.stiffness = kNan; }));
  EXPECT_TRUE(refused([](TickSettings& s) { s.damping = -1.0; }));
  EXPECT_TRUE(refused([](TickSettings& s) { s.motion_scale = 0.0; }));
  EXPECT_TRUE(refused([](TickSettings& s) { s.force_scale = kNan; }));
  EXPECT_TRUE(refused([](TickSettings& s) { s.max_force = 0.0; }));
  EXPECT_TRUE(refused([](TickSettings& s) { s.ramp_ticks = 0; }));
  EXPECT_TRUE(refused([](TickSettings& s) { s.lost_ticks = s.late_ticks; }));
  EXPECT_TRUE(refused([](TickSettings& s) { s.reserve = -1.0; }));
  EXPECT_TRUE(refused([](TickSettings& s) { s.velocity_cutoff = 0.0; }));
}

}  // namespace
}  // namespace rhexis::haptics::test
