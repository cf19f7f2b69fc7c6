#include "haptics/loop.h"

#include <pthread.h>
#include <sched.h>
#include <sys/prctl.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <ctime>
#include <system_error>

#include <fmt/format.h>

#include "base/check.h"

namespace rhexis::haptics {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;  // ns
constexpr std::int64_t kPeriod = 1'000'000;      // ns
static_assert(kPeriod == static_cast<std::int64_t>(kTickSeconds * 1e9 + 0.5));
/// Ticks that are behind by no more than this many periods are made good at once, so that a tick stays a millisecond; a
/// loop that was stopped for longer gives the time up.
constexpr std::int64_t kMostBehind = 20;

std::int64_t time_of(clockid_t clock) noexcept {
  timespec time{};
  clock_gettime(clock, &time);
  return time.tv_sec * kSecond + time.tv_nsec;
}

void sleep_until(std::int64_t at) noexcept {
  const timespec time{at / kSecond, at % kSecond};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &time, nullptr) == EINTR) {
  }
}

/// What the tick before has to do with one that begins `late`.
struct LastTick {
  std::int64_t end = 0;  ///< ns
  std::int64_t wall = 0;
  std::int64_t processor = 0;
  LateCause cause = LateCause::none;

  [[nodiscard]] LateCause cause_of_next(std::int64_t due) const noexcept {
    if (end <= due) return LateCause::woken_late;
    if (wall <= kPeriod) return cause;  // it had been late itself
    return processor > kPeriod / 2 ? LateCause::own_work : LateCause::interrupted;
  }
};

TickSample make_sample(const Reading& reading, bool fresh, std::int64_t late, const HandState& hand) noexcept {
  TickSample out;
  out.tick = hand.tick;
  out.number = hand.number;
  out.position = {reading.position[0], reading.position[1], reading.position[2]};
  out.buttons = reading.buttons;
  out.present = reading.present ? 1 : 0;
  out.fresh = fresh ? 1 : 0;
  out.late = static_cast<std::uint16_t>(std::clamp<std::int64_t>(late / 1000, 0, 65535));
  out.grasp = hand.grasp;
  out.flags = hand.flags;
  out.hand = hand.hand;
  out.force = hand.force;
  return out;
}

}  // namespace

HapticLoop::HapticLoop(Device& device, NewestValue<response::ForceSnapshot>& laws, NewestValue<HandState>& hand,
                       TickRing& trace, const LoopSettings& settings)
    : device_(device), laws_(laws), hand_(hand), trace_(trace), settings_(settings) {}

HapticLoop::~HapticLoop() { stop(); }

Expected<void> HapticLoop::start() {
  RHEXIS_CHECK(!thread_.joinable(), "the haptic loop runs already");
  if (Expected<void> good = check_settings(settings_.tick); !good) return good;
  if (Expected<void> opened = device_.open(); !opened) return opened;
  stops_ = false;
  try {
    thread_ = std::thread([this] { run(); });
  } catch (const std::system_error& error) {
    device_.close();
    return fail(fmt::format("no thread for the haptic loop: {}", error.what()));
  }
  ask_for_priority();
  return {};
}

void HapticLoop::stop() {
  if (!thread_.joinable()) return;
  stops_ = true;
  thread_.join();
  device_.write(Vec3::Zero());
  device_.close();
}

void HapticLoop::ask_for_priority() {
  sched_param wanted{};
  wanted.sched_priority = settings_.priority;
  if (settings_.priority <= 0) {
    priority_text_ = "no real-time priority was asked for";
    return;
  }
  const int code = pthread_setschedparam(thread_.native_handle(), SCHED_FIFO, &wanted);
  realtime_ = code == 0;
  priority_text_ = realtime_ ? fmt::format("real-time priority {} (SCHED_FIFO)", settings_.priority)
                             : fmt::format("no real-time priority: {} (allow it: ulimit -r {}, or CAP_SYS_NICE)",
                                           std::strerror(code), settings_.priority);
}

void HapticLoop::run() noexcept {
  prctl(PR_SET_TIMERSLACK, 1UL);  // ns; without it the kernel may wake an ordinary thread 50 us late on purpose
  HapticTick tick(settings_.tick, device_.traits());
  response::ForceSnapshot law;
  std::int64_t due = time_of(CLOCK_MONOTONIC) + kPeriod;
  std::int64_t processor = time_of(CLOCK_THREAD_CPUTIME_ID);
  LastTick last;
  for (std::uint64_t number = 0; !stops_.load(std::memory_order_relaxed); ++number) {
    sleep_until(due);
    const std::int64_t begin = time_of(CLOCK_MONOTONIC);
    const std::int64_t late = std::max<std::int64_t>(0, begin - due);
    const LateCause cause = last.cause_of_next(due);
    if (late > kMostBehind * kPeriod) {
      const std::int64_t behind = late / kPeriod;
      due += behind * kPeriod;
      statistics_.add_skipped(static_cast<std::uint64_t>(behind));
    }

    const bool fresh = laws_.take(law);  // before the device: a hold that has come is felt from where its hand is
    const Reading reading = device_.read(number);
    const TickOutput out = tick.step(reading, law, fresh);
    device_.write(out.force);
    hand_.publish(out.hand);
    trace_.push(make_sample(reading, fresh, late, out.hand));

    last.cause = cause;
    last.end = time_of(CLOCK_MONOTONIC);
    const std::int64_t spent = time_of(CLOCK_THREAD_CPUTIME_ID);
    last.wall = last.end - begin;
    last.processor = spent - processor;
    processor = spent;
    const bool holds = (out.hand.flags & HandState::holds) != 0;
    statistics_.add(
        {number, 1e-3 * static_cast<double>(late), 1e-3 * static_cast<double>(last.wall), cause, holds, out.law_age});
    due += kPeriod;
  }
}

}  // namespace rhexis::haptics
