#include "apps/progress.h"

#include <algorithm>
#include <cstdio>

#include <fmt/format.h>
#include <unistd.h>

namespace rhexis::apps {
namespace {

constexpr double kSilentSeconds = 2.0;
constexpr int kBarWidth = 30;

}  // namespace

Progress::Progress(bool shown) : shown_(shown), terminal_(::isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  if (bar_drawn_) fmt::print(stderr, "\r\033[K");
}

void Progress::update(double fraction, const std::string& text) {
  const double elapsed = watch_.seconds();
  if (!shown_ || elapsed < kSilentSeconds) return;
  if (!terminal_) {
    fmt::print(stderr, "{:3.0f}%  {:6.1f} s  {}\n", 100.0 * fraction, elapsed, text);
    return;
  }
  const int full = std::clamp(static_cast<int>(fraction * kBarWidth), 0, kBarWidth);
  const double left = fraction > 0.0 ? elapsed * (1.0 - fraction) / fraction : 0.0;
  fmt::print(stderr, "\r\033[K[{:#<{}}{:.<{}}] {:3.0f}%  {:.0f} s left  {}", "", full, "", kBarWidth - full,
             100.0 * fraction, left, text);
  std::fflush(stderr);
  bar_drawn_ = true;
}

}  // namespace rhexis::apps
