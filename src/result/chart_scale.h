#pragma once

/// One axis of a chart: from numbers to places along it, and the round numbers it is labelled with.

#include <string>
#include <vector>

namespace rhexis::result {

enum class Scale { linear, log };

/// Numbers of greater magnitude are not drawn.
inline constexpr double kLargestDrawn = 1e100;

struct Tick {
  double value = 0.0;
  std::string label;  ///< UTF-8; empty for a line without a number (between the powers of ten)
};

class ChartScale {
 public:
  /// From `low` to `high`, low <= high, both of magnitude kLargestDrawn at most; on a log scale its inverse at least.
  /// What is too narrow to tell numbers apart is widened.
  ChartScale(Scale scale, double low, double high);

  [[nodiscard]] double from() const { return from_; }
  [[nodiscard]] double to() const { return to_; }
  /// 0 at from(), 1 at to(); beyond them outside of [0, 1].
  [[nodiscard]] double place(double value) const;
  /// Round numbers, ascending, about `wanted` of them with a label: multiples of 1, 2 or 5 times a power of ten, or
  /// powers of ten with as many of 2 and 5 in between as there is room for.
  [[nodiscard]] std::vector<Tick> ticks(int wanted) const;

 private:
  [[nodiscard]] std::vector<Tick> linear_ticks(int wanted) const;
  [[nodiscard]] std::vector<Tick> log_ticks(int wanted) const;

  Scale scale_;
  double from_;
  double to_;
};

}  // namespace rhexis::result
