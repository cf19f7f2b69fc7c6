#pragma once

#include <csignal>

namespace rhexis::apps {

/// Ctrl-C ends a run after the step in flight, with the results so far; pressed twice it ends the program.
/// One within another sees what was asked of the outer one.
class Interrupt {
 public:
  Interrupt() {
    if (alive_++ > 0) return;
    asked_ = 0;
    std::signal(SIGINT, [](int) {
      asked_ = 1;
      std::signal(SIGINT, SIG_DFL);
    });
  }
  ~Interrupt() {
    if (--alive_ == 0) std::signal(SIGINT, SIG_DFL);
  }
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;
  [[nodiscard]] bool asked() const { return asked_ != 0; }

 private:
  inline static volatile std::sig_atomic_t asked_ = 0;
  inline static int alive_ = 0;
};

}  // namespace rhexis::apps
