#pragma once

/// Progress of long work: nothing in the first two seconds, then a bar on a terminal and a line a step elsewhere, on
/// stderr.

#include <string>

#include "base/clock.h"

namespace rhexis::apps {

class Progress {
 public:
  explicit Progress(bool shown);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// `fraction` in [0, 1]; `text` says what has just been done.
  void update(double fraction, const std::string& text);

 private:
  bool shown_;
  bool terminal_;
  bool bar_drawn_ = false;
  Stopwatch watch_;
};

}  // namespace rhexis::apps
