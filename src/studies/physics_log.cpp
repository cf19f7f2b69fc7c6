#include "studies/physics_log.h"

#include <algorithm>
#include <ctime>
#include <string_view>

#include <fmt/format.h>

#include "studies/probed_device.h"

namespace rhexis::studies {
namespace {

std::int64_t processor_ns() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return std::int64_t{1'000'000'000} * time.tv_sec + time.tv_nsec;
}

std::string counted(std::size_t count, std::string_view one, std::string_view many) {
  return fmt::format("{} {}", count, count == 1 ? one : many);
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
  const auto before = [](const PhysicsEvent& event, std::int64_t time) { return event.at < time; };
  const auto first = std::lower_bound(events.begin(), events.end(), from, before);
  if (first == events.end()) return "the physics sent nothing after it";
  const auto last = std::min(std::lower_bound(first, events.end(), to, before), std::prev(events.end()));
  std::size_t edits = 0, bodies = 0, states = 0;
  double milliseconds = 0.0;
  for (auto event = first; event <= last; ++event) {
    edits += event->kind == wire::Payload::Edit ? 1 : 0;
    bodies += event->kind == wire::Payload::Body ? 1 : 0;
    states += event->kind == wire::Payload::State ? 1 : 0;
    milliseconds += event->milliseconds;
  }
  std::vector<std::string> did;
  if (edits > 0)
    did.push_back(counted(edits, "advance", "advances") + fmt::format(" of the crack ({:.1f} ms)", milliseconds));
  if (bodies > 0) did.push_back(counted(bodies, "whole Body", "whole Bodies"));
  if (states > 0) did.push_back(counted(states, "State", "States"));
  if (did.empty()) did.emplace_back("steps");
  std::string text = fmt::format("the physics: {}", fmt::join(did, ", "));
  if (first == events.begin()) return text;
  const PhysicsEvent& begin = *std::prev(first);
  return text + fmt::format("; {:.1f} of {:.1f} ms on a processor",
                            1e-6 * static_cast<double>(last->processor - begin.processor),
                            1e-6 * static_cast<double>(last->at - begin.at));
}

}  // namespace rhexis::studies
