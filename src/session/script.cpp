#include "session/script.h"

#include <cmath>

namespace rhexis::session {
namespace {

/// A tick is 1 ms.
std::uint64_t ticks_of(double seconds) { return static_cast<std::uint64_t>(std::llround(1000.0 * seconds)); }

}  // namespace

Script::Does Script::step(const std::vector<scene::PullSettings>& pulls, std::uint64_t now, std::uint64_t passed,
                          bool runs) {
  if (!on_) return Does::nothing;
  if (waiting_) {
    if (runs) taken_ += passed;
    if (taken_ < ticks_of(pulls[next_].wait)) return Does::nothing;
    go_to_next(pulls.size());
    return on_ ? Does::nothing : Does::ends;
  }
  if (!pulling_) {
    if (next_ >= pulls.size()) {
      end();
      return Does::nothing;
    }
    if (!runs) return Does::nothing;
    const scene::PullSettings& pull = pulls[next_];
    pulling_ = true;
    taken_ = 0;
    orders_ = {.hold = ++pulls_,
               .runs = 1,
               .since = now,
               .elapsed = 0,
               .moving = std::max<std::uint64_t>(1, ticks_of(pull.seconds)),
               .by = {pull.by[0], pull.by[1], pull.by[2]}};
    return Does::grasps;
  }
  if (orders_.runs != 0) taken_ += passed;
  if ((orders_.runs != 0) != runs) {
    orders_.runs = runs ? 1 : 0;
    orders_.since = now;
    orders_.elapsed = taken_;
  }
  if (taken_ < orders_.moving + ticks_of(pulls[next_].hold)) return Does::nothing;
  pulling_ = false;
  orders_ = {};
  taken_ = 0;
  waiting_ = ticks_of(pulls[next_].wait) > 0;
  if (!waiting_) go_to_next(pulls.size());
  return Does::lets_go;
}

void Script::go_to_next(std::size_t pulls) {
  waiting_ = false;
  ++next_;
  if (next_ == pulls) end();
}

double script_seconds(const std::vector<scene::PullSettings>& pulls) {
  double sum = 0.0;
  for (const scene::PullSettings& pull : pulls) sum += pull.seconds + pull.hold + pull.wait;
  return sum;
}

}  // namespace rhexis::session
