#include "studies/physics_log.h"

#include <algorithm>
#include <ctime>

#include <fmt/format.h>

#include "studies/probed_device.h"

namespace rhexis::studies {
namespace {

std::int64_t processor_ns() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return std::int64_t{1'000'000'000} * time.tv_sec + time.tv_nsec;
}

std::string name_of(const PhysicsEvent& event) {
  switch (event.kind) {
    case wire::Payload::Edit: return fmt::format("an advance of the crack ({:.1f} ms)", event.milliseconds);
    case wire::Payload::Body: return "a whole Body, after a reset or 32 edits";
    case wire::Payload::State: return "steps and a State";
    default: return "steps";
  }
}

}  // namespace

void PhysicsLog::take(const wire::SharedMessage& message) {
  PhysicsEvent event{.at = now_ns(), .processor = processor_ns(), .kind = message->kind};
  if (event.kind == wire::Payload::Edit)
    event.milliseconds = wire::GetFrame(message->bytes.data())->payload_as_Edit()->advance()->milliseconds();
  events_.push_back(event);
  to_->take(message);
}

std::string physics_between(const std::vector<PhysicsEvent>& events, std::int64_t from, std::int64_t to) {
  // What lies between two frames belongs to the later one.
  const auto before = [](const PhysicsEvent& event, std::int64_t time) { return event.at < time; };
  auto event = std::lower_bound(events.begin(), events.end(), from, before);
  auto longest = events.end();
  std::int64_t most = 0;
  for (; event != events.end(); ++event) {
    const std::int64_t begin = event == events.begin() ? from : std::max(from, std::prev(event)->at);
    if (begin >= to) break;
    const std::int64_t shared = std::min(to, event->at) - begin;
    if (shared < most) continue;
    most = shared;
    longest = event;
  }
  if (longest == events.end()) return "no frame of the physics followed";
  std::string text = "physics: " + name_of(*longest);
  if (longest == events.begin()) return text;
  const PhysicsEvent& last = *std::prev(longest);
  return text + fmt::format(", {:.1f} of {:.1f} ms on a processor",
                            1e-6 * static_cast<double>(longest->processor - last.processor),
                            1e-6 * static_cast<double>(longest->at - last.at));
}

}  // namespace rhexis::studies
