#pragma once

/// The two neighbours of a value on an axis of a record, and their weights: (4.14), (4.25), (4.26) of the thesis. No
/// memory is asked for.

#include <array>
#include <span>

namespace rhexis::record::store {

struct Neighbours {
  std::array<int, 2> index{0, 0};
  std::array<double, 2> weight{1.0, 0.0};  ///< sum 1, none negative; {1, 0} where there is one
  bool outside = false;  ///< the value is beyond the axis: its end was taken. An axis of one entry has only that value
};

/// On an ascending axis of at least one entry.
[[nodiscard]] Neighbours neighbours_on(std::span<const double> axis, double value);
/// On one that closes at 360, whose entries ascend from 0: directions of a pull, degrees; `value` may be any angle.
[[nodiscard]] Neighbours neighbours_around(std::span<const double> axis, double value);
/// The entry that differs least, of two the lower; (4.8), (4.9).
[[nodiscard]] int nearest_on(std::span<const double> axis, double value);

}  // namespace rhexis::record::store
