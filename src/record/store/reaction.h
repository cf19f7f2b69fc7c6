#pragma once

/// What a record says to a body that tears: the nearest topology, (4.8) and (4.9) of the thesis, and the force between
/// recorded ones, (4.27) to the letter. No memory is asked for.

#include <span>
#include <vector>

#include "record/store/record.h"

namespace rhexis::record::store {

/// An advance that was made.
struct Advanced {
  double angle = 0.0;   ///< degrees, in the record's frame
  double length = 0.0;  ///< m
};

struct Reaction {
  Vec3 force = Vec3::Zero();  ///< N, of the hand on the body
  bool outside = false;       ///< some angle or length lies beyond the record: the nearest was taken
  bool past_last = false;     ///< more advances than the record has: the first of them count
  bool out_of_plane = false;  ///< the pull leaves the plane of the recorded ones: only its part in the plane counts
  bool torn_off = false;      ///< the point is out of the solve in a topology that counts
};

struct Nearest {
  int topology = 0;
  bool outside = false;
  bool past_last = false;
};

/// Keeps the record; the record does not change.
class Lookup {
 public:
  explicit Lookup(const Record& record);

  /// (4.8), (4.9).
  [[nodiscard]] Nearest nearest(std::span<const Advanced> advances) const;
  /// (4.27): 2^(2n+1) recorded reactions of grasp point `point`, scaled by the length of the pull over the recorded
  /// one. `pull`: m, of the point beyond where the loads alone put it.
  [[nodiscard]] Reaction reaction(std::span<const Advanced> advances, int point, const Vec3& pull) const;
  /// The recorded reaction of one topology to one recorded pull, N.
  [[nodiscard]] Vec3 recorded(int topology, int point, int pull_direction) const;
  /// (4.15): between pull directions alone, in one topology. N.
  [[nodiscard]] Vec3 recorded_in(int topology, int point, const Vec3& pull) const;

 private:
  [[nodiscard]] std::span<const Advanced> counted(std::span<const Advanced> advances) const;

  const Record& record_;
  Numbering numbering_;
  std::vector<double> angles_;       ///< degrees
  std::vector<double> pull_angles_;  ///< degrees
  std::vector<Vec3> pulls_;          ///< m, per pull direction
};

}  // namespace rhexis::record::store
