#include "haptics/loop.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <ctime>
#include <memory>
#include <thread>
#include <vector>

#include "haptics/emulator_device.h"
#include "haptics/pointer_device.h"
#include "tests/haptics/laws.h"
#include "tests/support/counted_allocations.h"

namespace rhexis::haptics::test {
namespace {

using rhexis::test::allocations;
using testing::HasSubstr;

void sleep_ms(long milliseconds) {
  const timespec time{milliseconds / 1000, milliseconds % 1000 * 1'000'000};
  nanosleep(&time, nullptr);
}

struct Surroundings {
  NewestValue<ForceSnapshot> laws;
  NewestValue<HandState> hand;
  TickRing trace;
};

/// Until so many ticks are done, ten seconds at most.
bool wait_for(const HapticLoop& loop, std::uint64_t ticks) {
  for (int k = 0; k < 10'000; ++k) {
    if (loop.statistics().ticks >= ticks) return true;
    sleep_ms(1);
  }
  return false;
}

TEST(HapticLoop, TakesNoMemoryInAThousandTicks) {
#ifndef RHEXIS_COUNTS_MALLOC
  GTEST_SKIP() << "the sanitizer has its own malloc";
#else
  const auto around = std::make_unique<Surroundings>();
  EmulatorDevice device({}, moving({{.by = Vec3(0.02, 0.01, 0.0), .seconds = 0.5}}));
  HapticLoop loop(device, around->laws, around->hand, around->trace, {.tick = settings_for(device.traits())});
  std::mt19937_64 random(1);
  const ForceSnapshot law = make_law(random_stiffness(random));
  long before = allocations;
  static double* volatile seen = nullptr;  // what nobody sees may be left out
  seen = new double;
  delete seen;
  EXPECT_GT(allocations, before) << "the count has to see operator new";

  around->laws.publish(law);
  ASSERT_TRUE(loop.start());
  ASSERT_TRUE(wait_for(loop, 10));
  const std::uint64_t from = loop.statistics().ticks;
  before = allocations;
  for (int k = 0; k < 100; ++k) {
    around->laws.publish(law);
    sleep_ms(11);
  }
  const bool done = wait_for(loop, from + 1000);
  const long after = allocations;
  loop.stop();
  EXPECT_TRUE(done);
  EXPECT_EQ(after, before);
  HandState hand;
  ASSERT_TRUE(around->hand.take(hand));
  EXPECT_GT(vec(hand.force).norm(), 0.0);
#endif
}

TEST(HapticLoop, EachTickIsInTheTraceWithWhatMakesItAgain) {
  const auto around = std::make_unique<Surroundings>();
  EmulatorDevice device({}, moving({{.by = Vec3(0.02, 0.01, 0.0), .seconds = 0.2}}));
  const TickSettings settings = settings_for(device.traits());
  HapticLoop loop(device, around->laws, around->hand, around->trace, {.tick = settings});
  std::vector<ForceSnapshot> laws{ForceSnapshot{}};
  std::mt19937_64 random(2);
  ASSERT_TRUE(loop.start());
  for (std::uint64_t number = 1; number <= 30; ++number) {
    laws.push_back(make_law(random_stiffness(random), number < 20 ? 1 : 2, number));
    around->laws.publish(laws.back());
    sleep_ms(10);
  }
  loop.stop();

  HapticTick again(settings, device.traits());
  TickSample sample;
  std::uint64_t ticks = 0;
  int taken_up = 0;
  double force = 0.0;
  for (; around->trace.pop(sample); ++ticks) {
    ASSERT_EQ(sample.tick, ticks);
    Reading reading = at(vec(sample.position));
    reading.buttons = sample.buttons;
    reading.present = sample.present != 0;
    taken_up += sample.fresh;
    const TickOutput out = again.step(reading, laws.at(sample.number), sample.fresh != 0);
    ASSERT_EQ(out.hand.force, sample.force) << "bit for bit";
    ASSERT_EQ(out.hand.hand, sample.hand);
    ASSERT_EQ(out.hand.flags, sample.flags);
    force += vec(sample.force).norm();
  }
  EXPECT_EQ(ticks, loop.statistics().ticks);
  EXPECT_GT(ticks, 100u);
  EXPECT_GT(taken_up, 5);
  EXPECT_GT(force, 1.0);
}

TEST(HapticLoop, CountsItsTicksAndSaysHowLateTheyWere) {
  const auto around = std::make_unique<Surroundings>();
  PointerDevice device;
  HapticLoop loop(device, around->laws, around->hand, around->trace, {.tick = settings_for(device.traits())});
  std::mt19937_64 random(3);
  around->laws.publish(make_law(random_stiffness(random)));
  ASSERT_TRUE(loop.start());
  EXPECT_THAT(loop.priority_text(), HasSubstr("priority"));
  ASSERT_TRUE(wait_for(loop, 200));
  loop.stop();
  loop.stop();
  const TickReport report = loop.statistics();
  EXPECT_EQ(report.late.total(), report.ticks);
  EXPECT_EQ(report.work.total(), report.ticks);
  EXPECT_EQ(report.age.total(), report.ticks) << "held all the time";
  EXPECT_GT(report.worst_late, 0.0);
  EXPECT_NE(report.worst_cause, LateCause::none);
  EXPECT_LT(report.worst_tick, report.ticks);
  EXPECT_GT(report.work.part_below(1000.0), 0.9) << "a tick is a matter of microseconds";
  EXPECT_EQ(loop.take_worst(), report.worst_late);
  EXPECT_EQ(loop.take_worst(), 0.0);
}

/// Takes 40 ms in one tick: of the processor, or asleep.
class SlowDevice final : public Device {
 public:
  explicit SlowDevice(bool works) : works_(works) {}
  [[nodiscard]] const DeviceTraits& traits() const override { return traits_; }
  Reading read(std::uint64_t tick) noexcept override {
    if (tick == 50) {
      if (works_) {
        timespec now{};
        clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
        const double until = seconds(now) + 0.04;
        while (seconds(now) < until) clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
      } else {
        sleep_ms(40);
      }
    }
    return {};
  }
  void write(const Vec3&) noexcept override {}

 private:
  static double seconds(const timespec& time) {
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  }
  bool works_;
  DeviceTraits traits_ = pointing_device();
};

TEST(HapticLoop, NamesTheCauseOfTheWorstTickAndGivesUpWhatIsTooFarBehind) {
  for (const bool works : {true, false}) {
    const auto around = std::make_unique<Surroundings>();
    SlowDevice device(works);
    HapticLoop loop(device, around->laws, around->hand, around->trace, {.tick = settings_for(device.traits())});
    ASSERT_TRUE(loop.start());
    ASSERT_TRUE(wait_for(loop, 120));
    loop.stop();
    const TickReport report = loop.statistics();
    EXPECT_GT(report.worst_work, 39'000.0);
    EXPECT_GE(report.skipped, 39u) << "no forty ticks at once";
    EXPECT_GE(report.missed, 39u) << "which are missed all the same";
    EXPECT_GT(report.worst_late, 38'000.0);
    if (report.worst_tick == 51) {  // else the system has been worse than the device
      EXPECT_EQ(report.worst_cause, works ? LateCause::own_work : LateCause::interrupted);
    }
  }
}

TEST(HapticLoop, DoesNotStartWithADeviceThatDoesNotOpenOrBadSettings) {
  const auto around = std::make_unique<Surroundings>();
  EmulatorSettings no_mass;
  no_mass.mass = -1.0;
  EmulatorDevice broken(no_mass, at_rest());
  HapticLoop loop(broken, around->laws, around->hand, around->trace, {.tick = settings_for(broken.traits())});
  EXPECT_THAT(loop.start().error().message(), HasSubstr("mass"));
  PointerDevice pointer;
  LoopSettings settings;
  settings.tick.ramp_ticks = 0;
  HapticLoop other(pointer, around->laws, around->hand, around->trace, settings);
  EXPECT_THAT(other.start().error().message(), HasSubstr("ramp"));
}

TEST(TickStatistics, CountsBySizeAndSaysWhichPartIsBelow) {
  TickStatistics statistics;
  TickStatistics::Tick tick;
  tick = {.number = 1, .late = 0.5, .work = 3.0, .cause = LateCause::woken_late, .holds = true, .law_age = 4};
  for (int k = 0; k < 90; ++k) statistics.add(tick);
  tick.late = 100.0;
  tick.holds = false;
  for (int k = 0; k < 9; ++k) statistics.add(tick);
  statistics.add(
      {.number = 3, .late = 1500.0, .work = 40.0, .cause = LateCause::interrupted, .holds = false, .law_age = 0});
  const TickReport report = statistics.report();
  EXPECT_EQ(report.ticks, 100u);
  EXPECT_EQ(report.missed, 1u);
  EXPECT_EQ(report.late.count[0], 90u);
  EXPECT_DOUBLE_EQ(report.late.part_below(1.0), 0.90);
  EXPECT_DOUBLE_EQ(report.late.part_below(128.0), 0.99);
  EXPECT_DOUBLE_EQ(report.late.part_below(1500.0), 0.99) << "its bin goes on above";
  EXPECT_DOUBLE_EQ(report.late.part_below(1e9), 1.0);
  EXPECT_EQ(report.age.total(), 90u);
  EXPECT_EQ(report.oldest, 4u);
  EXPECT_EQ(report.oldest_tick, 1u);
  EXPECT_EQ(report.worst_tick, 3u);
  EXPECT_EQ(report.worst_late, 1500.0);
  EXPECT_EQ(report.worst_work, 40.0);
  EXPECT_EQ(report.worst_cause, LateCause::interrupted);
}

}  // namespace
}  // namespace rhexis::haptics::test
