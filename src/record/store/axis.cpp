#include "record/store/axis.h"

#include <algorithm>
#include <cmath>

namespace rhexis::record::store {

Neighbours neighbours_on(std::span<const double> axis, double value) {
  Neighbours out;
  const int last = static_cast<int>(axis.size()) - 1;
  if (!(value >= axis.front())) {
    out.outside = true;
  } else if (value >= axis.back()) {
    out.outside = value > axis.back();
    out.index = {last, last};
  } else {
    const auto above = std::upper_bound(axis.begin(), axis.end(), value);
    const double from = *(above - 1);
    out.index[1] = static_cast<int>(above - axis.begin());
    out.index[0] = out.index[1] - 1;
    out.weight = {(*above - value) / (*above - from), (value - from) / (*above - from)};
  }
  return out;
}

Neighbours neighbours_around(std::span<const double> axis, double value) {
  constexpr double kTurn = 360.0;
  double within = std::fmod(value, kTurn);
  if (within < 0.0) within += kTurn;
  if (within >= kTurn) within = 0.0;  // what a tiny negative angle rounds to
  Neighbours out;
  const auto above = std::upper_bound(axis.begin(), axis.end(), within);
  out.index[0] = static_cast<int>(above - axis.begin()) - 1;
  if (axis.size() == 1) return out;
  const double from = axis[static_cast<std::size_t>(out.index[0])];
  const double to = above == axis.end() ? axis.front() + kTurn : *above;
  out.index[1] = above == axis.end() ? 0 : out.index[0] + 1;
  out.weight = {(to - within) / (to - from), (within - from) / (to - from)};
  return out;
}

int nearest_on(std::span<const double> axis, double value) {
  const Neighbours near = neighbours_on(axis, value);
  return near.weight[1] > near.weight[0] ? near.index[1] : near.index[0];
}

}  // namespace rhexis::record::store
