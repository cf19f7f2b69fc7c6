// No energy given out over any closed loop of motion, torn or not (docs/haptics.md, "Energy").

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "haptics/emulator_device.h"
#include "haptics/tick.h"
#include "tests/haptics/laws.h"

namespace rhexis::haptics::test {
namespace {

constexpr double kRounding = std::numeric_limits<double>::epsilon();

/// A closed motion that begins and ends at rest, built of frequencies below `highest` Hz.
class ClosedMotion {
 public:
  ClosedMotion(std::mt19937_64& random, int ticks, double highest, double size) : ticks_(ticks) {
    const int most = std::max(2, static_cast<int>(highest * ticks * kTickSeconds) - 2);
    for (int k = 0; k < 6; ++k) {
      waves_.push_back({1 + static_cast<int>(random() % static_cast<std::uint64_t>(most)), size * random_vector(random),
                        size * random_vector(random)});
    }
  }
  [[nodiscard]] Vec3 at(int tick) const {
    const double turn = 2.0 * std::numbers::pi * tick / ticks_;
    Vec3 sum = Vec3::Zero();
    for (const Wave& wave : waves_) {
      sum += wave.odd * std::sin(wave.number * turn) / wave.number;
      sum += wave.even * (std::cos(wave.number * turn) - 1.0) / wave.number;
    }
    return 0.5 * (1.0 - std::cos(turn)) * sum;  // the window raises the frequency by one over the time
  }

 private:
  struct Wave {
    int number;
    Vec3 odd, even;
  };
  int ticks_;
  std::vector<Wave> waves_;
};

struct Walk {
  double given = 0.0;       ///< J, over all
  double most = 0.0;        ///< J, most that had been given at any time
  double turnover = 0.0;    ///< J, sum of |F . dx|: what rounding is measured by
  double worst_step = 0.0;  ///< J, the most that one tick gave
  double least_gain = 1.0;
  int law_changes = 0;
};

/// `place` of a tick, and the physics by `law_at`: the law in it, which comes where `comes` says so.
template <typename Place, typename LawAt>
Walk walk(
    HapticTick& tick, int ticks, const Place& place, const LawAt& law_at,
    const std::function<bool(int)>& comes = [](int) { return true; }) {
  Walk out;
  ForceSnapshot law;
  Vec3 force = Vec3::Zero();
  Vec3 position = place(0);
  // At rest where it begins, until the grip is closed.
  for (int k = 0; k < 200; ++k) {
    law = law_at(0);
    force = tick.step(at(position), law, true).force;
  }
  for (int t = 1; t <= ticks; ++t) {
    const Vec3 next = place(t);
    const double step = force.dot(next - position);
    out.given += step;
    out.most = std::max(out.most, out.given);
    out.turnover += std::abs(step);
    out.worst_step = std::max(out.worst_step, step);
    position = next;
    const bool fresh = comes(t);
    if (fresh) {
      const ForceSnapshot now = law_at(t);
      out.law_changes += now.number != law.number ? 1 : 0;
      law = now;
    }
    const TickOutput got = tick.step(at(position), law, fresh);
    EXPECT_NEAR(got.given, out.given, 1e3 * kRounding * (1e-3 + out.turnover));
    out.least_gain = std::min(out.least_gain, got.gain);
    force = got.force;
  }
  return out;
}

/// What sums of so many terms are wrong by: n eps times the sum of their sizes, at worst.
double rounding_of(const Walk& walk, int ticks) { return ticks * kRounding * walk.turnover; }

HapticTick strong_tick(bool restrains = true) {
  TickSettings settings = settings_for(strong_device());
  settings.restrains = restrains;
  return HapticTick(settings, strong_device());
}

constexpr int kTicks = 2000;
constexpr double kHand = 20.0;  // Hz, above any hand

TEST(Passivity, TheCouplingAloneIsPassiveFarAboveWhatAHandCanDo) {
  EXPECT_GT(passive_below(settings_for(strong_device())), 3.0 * kHand);
  TickSettings weak = settings_for(strong_device());
  weak.damping = 0.49 * weak.stiffness * kTickSeconds;
  EXPECT_EQ(passive_below(weak), 0.0) << "less than k T / 2";
}

TEST(Passivity, OneLawGivesNothingOutOverAnyClosedMotionOfAHandByTheCouplingAlone) {
  std::mt19937_64 random(11);
  int limited = 0;
  for (int k = 0; k < 100; ++k) {
    const ForceSnapshot law = make_law(random_stiffness(random));
    HapticTick tick = strong_tick(false);
    const ClosedMotion motion(random, kTicks, kHand, k % 2 == 0 ? 0.004 : 0.04);
    const Walk got = walk(
        tick, kTicks, [&](int t) { return motion.at(t); }, [&](int) { return law; });
    EXPECT_LE(got.given, rounding_of(got, kTicks));
    EXPECT_GT(got.turnover, 1e-5);
    limited += got.turnover > 1.0 ? 1 : 0;
  }
  EXPECT_GT(limited, 5) << "some have to run into the limit of the force";
}

TEST(Passivity, WithoutDampingSamplingGivesOut) {
  std::mt19937_64 random(11);
  TickSettings settings = settings_for(strong_device());
  settings.damping = 0.0;
  settings.restrains = false;
  HapticTick tick(settings, strong_device());
  const ForceSnapshot law = make_law(random_stiffness(random));
  const ClosedMotion motion(random, kTicks, kHand, 0.01);
  const Walk got = walk(
      tick, kTicks, [&](int t) { return motion.at(t); }, [&](int) { return law; });
  EXPECT_GT(got.given, 1e3 * rounding_of(got, kTicks)) << "what the tests around have to be able to see";
}

/// Tears: the body gets softer by a random positive semi-definite part, now and then; rests at zero (no loads).
struct Tearing {
  std::mt19937_64* random;
  Mat3 stiffness;
  ForceSnapshot law;
  bool back = false;  ///< some tears are taken back
  Mat3 before;

  Tearing(std::mt19937_64& of, bool takes_back)
      : random(&of), stiffness(random_stiffness(of)), law(make_law(stiffness)), back(takes_back), before(stiffness) {}

  const ForceSnapshot& at(int t) {
    if (t > 0 && (*random)() % 100 == 0) {
      if (back && (*random)() % 3 == 0) {
        stiffness = before;
      } else {
        before = stiffness;
        const Vec3 weak = random_vector(*random).normalized();
        // K - c (K w)(K w)^T / (w K w), which stays positive for c < 1
        const Vec3 pull = stiffness * weak;
        stiffness -= 0.5 * (1.0 + 0.9 * uniform(*random)) * pull * pull.transpose() / weak.dot(pull);
      }
      const std::uint64_t number = law.number + 1;
      law = make_law(stiffness, 1, number);
    }
    return law;
  }
};

TEST(Passivity, ABodyThatTearsGivesNothingOut) {
  std::mt19937_64 random(12);
  int tears = 0;
  for (int k = 0; k < 100; ++k) {
    Tearing tearing(random, false);
    HapticTick tick = strong_tick();
    const ClosedMotion motion(random, kTicks, kHand, 0.01);
    const Walk got = walk(
        tick, kTicks, [&](int t) { return motion.at(t); }, [&](int t) { return tearing.at(t); });
    EXPECT_LE(got.given, rounding_of(got, kTicks));
    EXPECT_LE(got.most, rounding_of(got, kTicks)) << "nor at any time on the way";
    tears += got.law_changes;
  }
  EXPECT_GT(tears, 1000);
}

TEST(Passivity, TearsThatAreTakenBackAreFeltAsFarAsTheHandHasPaidForThem) {
  std::mt19937_64 random(13);
  double least = 1.0;
  for (int k = 0; k < 100; ++k) {
    Tearing tearing(random, true);
    HapticTick tick = strong_tick();
    const ClosedMotion motion(random, kTicks, kHand, 0.01);
    const Walk got = walk(
        tick, kTicks, [&](int t) { return motion.at(t); }, [&](int t) { return tearing.at(t); });
    EXPECT_LE(got.most, rounding_of(got, kTicks));
    least = std::min(least, got.least_gain);
  }
  EXPECT_LT(least, 0.9) << "some of them the hand has not paid for";
}

TEST(Passivity, WithoutTheLedgerTearsTakenBackGiveOut) {
  std::mt19937_64 random(13);
  double most = 0.0;
  for (int k = 0; k < 20; ++k) {
    Tearing tearing(random, true);
    HapticTick tick = strong_tick(false);
    const ClosedMotion motion(random, kTicks, kHand, 0.01);
    most = std::max(most, walk(
                              tick, kTicks, [&](int t) { return motion.at(t); }, [&](int t) { return tearing.at(t); })
                              .most);
  }
  EXPECT_GT(most, 1e-4);
}

TEST(Passivity, LoadsThatPullATornBodyAwayGiveOutNoMoreThanTheHandHasLost) {
  std::mt19937_64 random(14);
  for (int k = 0; k < 50; ++k) {
    ForceSnapshot law = make_law(random_stiffness(random));
    HapticTick tick = strong_tick();
    const ClosedMotion motion(random, kTicks, kHand, 0.01);
    const auto sagging = [&](int t) {
      if (t > 0 && t % 150 == 0) {
        const std::uint64_t number = law.number + 1;
        const Vec3 rest = vec(law.rest) + 0.005 * random_vector(random);
        law = make_law(random_stiffness(random), 1, number);
        law.rest = {rest[0], rest[1], rest[2]};
      }
      return law;
    };
    const Walk got = walk(
        tick, kTicks, [&](int t) { return motion.at(t); }, sagging);
    EXPECT_LE(got.most, rounding_of(got, kTicks));
    EXPECT_GT(got.law_changes, 10);
  }
}

TEST(Passivity, QuantisedPositionsAndAPhysicsThatComesAndGoesGiveOutNoMoreThanOneTick) {
  std::mt19937_64 random(15);
  constexpr double kQuantum = 6e-5;  // m
  for (int k = 0; k < 50; ++k) {
    Tearing tearing(random, true);
    HapticTick tick = strong_tick();
    const ClosedMotion motion(random, kTicks, kHand, 0.01);
    const auto place = [&](int t) {
      Vec3 out = motion.at(t);
      for (int i = 0; i < 3; ++i) out[i] = kQuantum * std::round(out[i] / kQuantum);
      return out;
    };
    const Walk got = walk(
        tick, kTicks, place, [&](int t) { return tearing.at(t); }, [](int t) { return (t / 400) % 2 == 0; });
    EXPECT_LE(got.given, got.worst_step);
  }
}

TEST(Passivity, AHandThatTremblesAtASoftBodyKeepsItsForce) {
  std::vector<Leg> legs{{.by = Vec3(0.03, 0.01, 0.0), .seconds = 0.5}};
  for (int k = 0; k < 160; ++k)  // 8 Hz for ten seconds, half a millimetre
    legs.push_back({.by = (k % 2 == 0 ? 1.0 : -1.0) * Vec3(2e-4, 4e-4, -2e-4), .seconds = 0.0625});
  EmulatorSettings settings;
  settings.hand_stiffness = 400.0;
  settings.hand_damping = 4.0;
  settings.start = Vec3(1e-5, -2e-5, 0.0);  // not in the middle of a step
  EmulatorDevice device(settings, moving(legs));
  ASSERT_TRUE(device.open());
  HapticTick tick(settings_for(device.traits()), device.traits());
  ForceSnapshot law = make_law(Vec3(300.0, 250.0, 80.0).asDiagonal());
  TickOutput out;
  for (std::uint64_t t = 0; t < 10'500; ++t) {
    out = tick.step(device.read(t), law, t % 10 == 0);
    device.write(out.force);
  }
  EXPECT_GT(out.force.norm(), 3.0);
  EXPECT_GT(out.gain, 0.95);
  EXPECT_LT(device.taken(), 0.0);
}

TEST(Passivity, NoiseGivesOutNoMoreThanATickAtATime) {
  std::mt19937_64 random(16);
  for (int k = 0; k < 20; ++k) {
    const ForceSnapshot law = make_law(random_stiffness(random));
    HapticTick tick = strong_tick();
    std::vector<Vec3> places(1, Vec3::Zero());
    for (int t = 1; t < kTicks; ++t) places.push_back(1e-3 * random_vector(random));
    places.push_back(Vec3::Zero());
    const Walk got = walk(
        tick, kTicks, [&](int t) { return places[static_cast<std::size_t>(t)]; }, [&](int) { return law; });
    EXPECT_LE(got.most, 20.0 * got.worst_step) << "of " << kTicks << " ticks";
    EXPECT_LT(got.least_gain, 0.5);
  }
}

}  // namespace
}  // namespace rhexis::haptics::test
