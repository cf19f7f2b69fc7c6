#pragma once

#include <csignal>

namespace rhexis::apps {

/// Ctrl-C, or SIGTERM, by which service managers and time limits end a program, ends a run after the step in flight,
/// with the results so far; a second one ends the program. One within another sees what was asked of the outer one.
class Interrupt {
 public:
  Interrupt() {
    if (alive_++ > 0) return;
    asked_ = 0;
    handle_by(ask);
  }
  ~Interrupt() {
    if (--alive_ == 0) handle_by(SIG_DFL);
  }
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;
  [[nodiscard]] bool asked() const { return asked_ != 0; }

 private:
  static void handle_by(void (*handler)(int)) {
    std::signal(SIGINT, handler);
    std::signal(SIGTERM, handler);
  }
  static void ask(int /*signal*/) {
    asked_ = 1;
    handle_by(SIG_DFL);
  }

  inline static volatile std::sig_atomic_t asked_ = 0;
  inline static int alive_ = 0;
};

}  // namespace rhexis::apps
