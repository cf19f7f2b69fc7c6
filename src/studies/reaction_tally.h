#pragma once

/// What is counted of the errors of recorded forces.

#include <array>
#include <cstdint>
#include <map>
#include <string_view>
#include <vector>

#include "studies/reaction_cell.h"

namespace rhexis::studies {

/// nearest: the nearest recorded topology, as it is. linear: (4.27) of the thesis, its weights linear in the angle.
/// local: response/local_ritz.h, the far field of the same recorded topologies about the crack as it is.
inline constexpr std::array<std::string_view, 3> kReactionWays{"nearest", "linear", "local"};

struct Moments {
  std::int64_t count = 0;
  double sum = 0.0;
  double squares = 0.0;
  double largest = 0.0;

  void add(double value);
  void merge(const Moments& other);
  [[nodiscard]] double mean() const { return sum / static_cast<double>(count); }
  [[nodiscard]] double deviation() const;
};

/// Errors |f - f_exact| of one way.
struct WayTally {
  Moments error;            ///< N
  Moments relative;         ///< of |f_exact|
  std::int64_t better = 0;  ///< patterns in which it is less than that of `nearest`
  std::int64_t tied = 0;    ///< as large, up to rounding
  void merge(const WayTally& other);
};
using Ways = std::array<WayTally, kReactionWays.size()>;

/// m, width of a class of distances.
inline constexpr double kDistanceClass = 0.01;

struct ReactionTally {
  Ways all;
  std::int64_t torn_off = 0;     ///< patterns left out
  std::map<double, Ways> angle;  ///< by the angle of the last advance, degrees
  std::map<int, Ways> distance;  ///< by the class of the point's distance from the crack
  void merge(const ReactionTally& other);
};

/// Pulls of a record: m.
[[nodiscard]] std::vector<Vec3> recorded_pulls(const record::store::Frame& frame);
/// Every pull at every sample. `points`: reference positions of the grasp points, m.
void count_errors(const ReactionQuery& query, const std::vector<Vec3>& pulls, const std::vector<Vec3>& points,
                  const record::store::Frame& frame, ReactionTally& tally);

}  // namespace rhexis::studies
