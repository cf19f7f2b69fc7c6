#pragma once

/// What a record says to a body that tears: the nearest topology, (4.8) and (4.9) of the thesis, and the force between
/// recorded ones, (4.27) to the letter. No memory is asked for.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "record/store/axis.h"
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

/// What an interpolation has left out.
struct Between {
  bool outside = false;    ///< as in Reaction
  bool past_last = false;  ///< as in Reaction
};

/// The stiffness of a grasp point between recorded topologies: what (4.27) says of every pull.
struct Stiffness {
  Mat3 value = Mat3::Zero();  ///< N/m, force of the hand on the body for a displacement of the point
  bool outside = false;       ///< as in Reaction
  bool past_last = false;     ///< as in Reaction
  bool torn_off = false;      ///< as in Reaction
};

/// Keeps the record; the record does not change.
class Lookup {
 public:
  explicit Lookup(const Record& record);

  /// use(topology, weight) for each of the 2^(2n) topologies of (4.27) that has a weight; they are positive, and their
  /// sum is 1.
  template <class Use>
  Between each_topology(std::span<const Advanced> advances, Use&& use) const;
  /// The same sum of stiffnesses.
  [[nodiscard]] Stiffness stiffness(std::span<const Advanced> advances, int point) const;

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

template <class Use>
Between Lookup::each_topology(std::span<const Advanced> advances, Use&& use) const {
  const std::vector<double>& lengths = record_.head.parameters.lengths;
  Between out;
  const std::span<const Advanced> used = counted(advances);
  out.past_last = used.size() < advances.size();
  std::array<Neighbours, kMostAdvances> w;
  std::array<Neighbours, kMostAdvances> u;
  for (std::size_t i = 0; i < used.size(); ++i) {
    w[i] = neighbours_on(angles_, used[i].angle);
    u[i] = neighbours_on(lengths, used[i].length);
    if (lengths.size() == 1) u[i].outside = false;  // the one length stands for all
    out.outside = out.outside || w[i].outside || u[i].outside;
  }
  // Bit 2 i of a term says which neighbour in angle of advance i it takes, bit 2 i + 1 which in length.
  const std::uint64_t terms = std::uint64_t{1} << (2 * used.size());
  for (std::uint64_t term = 0; term < terms; ++term) {
    double weight = 1.0;
    int topology = 0;
    for (std::size_t i = 0; i < used.size() && weight != 0.0; ++i) {
      const std::size_t a = term >> (2 * i) & 1U;
      const std::size_t b = term >> (2 * i + 1) & 1U;
      weight *= w[i].weight[a] * u[i].weight[b];
      topology = numbering_.child(topology, {w[i].index[a], u[i].index[b]});
    }
    if (weight != 0.0) use(topology, weight);
  }
  return out;
}

}  // namespace rhexis::record::store
