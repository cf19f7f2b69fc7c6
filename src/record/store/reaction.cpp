#include "record/store/reaction.h"

#include <cmath>
#include <numbers>

namespace rhexis::record::store {
namespace {

/// A pull leaves the plane when its part across is more than this part of it.
constexpr double kInPlane = 1e-9;

}  // namespace

Lookup::Lookup(const Record& record)
    : record_(record),
      numbering_(record.head.parameters),
      angles_(direction_angles(record.head.parameters)),
      pull_angles_(store::pull_angles(record.head.parameters)) {
  for (const double angle : pull_angles_)
    pulls_.emplace_back(record.head.parameters.pull_length * record.head.frame.direction(angle));
}

std::span<const Advanced> Lookup::counted(std::span<const Advanced> advances) const {
  return advances.first(std::min(advances.size(), static_cast<std::size_t>(numbering_.advances())));
}

Nearest Lookup::nearest(std::span<const Advanced> advances) const {
  const std::vector<double>& lengths = record_.head.parameters.lengths;
  Nearest out;
  const std::span<const Advanced> used = counted(advances);
  out.past_last = used.size() < advances.size();
  for (const Advanced& advance : used) {
    out.outside = out.outside || neighbours_on(angles_, advance.angle).outside ||
                  (lengths.size() > 1 && neighbours_on(lengths, advance.length).outside);
    out.topology =
        numbering_.child(out.topology, {nearest_on(angles_, advance.angle), nearest_on(lengths, advance.length)});
  }
  return out;
}

Vec3 Lookup::recorded(int topology, int point, int pull_direction) const {
  return record_.stiffness_at(topology, point) * pulls_[static_cast<std::size_t>(pull_direction)];
}

Vec3 Lookup::recorded_in(int topology, int point, const Vec3& pull) const {
  const Frame& frame = record_.head.frame;
  const double x = pull.dot(frame.x);
  const double y = pull.dot(frame.y);
  const Neighbours v = neighbours_around(pull_angles_, std::atan2(y, x) * 180.0 / std::numbers::pi);
  const double scale = std::hypot(x, y) / record_.head.parameters.pull_length;
  return scale *
         (v.weight[0] * recorded(topology, point, v.index[0]) + v.weight[1] * recorded(topology, point, v.index[1]));
}

Reaction Lookup::reaction(std::span<const Advanced> advances, int point, const Vec3& pull) const {
  Reaction out;
  out.out_of_plane = std::abs(pull.dot(record_.head.frame.z)) > kInPlane * pull.norm();
  const Between between = each_topology(advances, [&](int topology, double weight) {
    out.torn_off = out.torn_off || !record_.is_in_solve(topology, point);
    out.force += weight * recorded_in(topology, point, pull);
  });
  out.outside = between.outside;
  out.past_last = between.past_last;
  return out;
}

Stiffness Lookup::stiffness(std::span<const Advanced> advances, int point) const {
  Stiffness out;
  const Between between = each_topology(advances, [&](int topology, double weight) {
    out.torn_off = out.torn_off || !record_.is_in_solve(topology, point);
    out.value += weight * record_.stiffness_at(topology, point);
  });
  out.outside = between.outside;
  out.past_last = between.past_last;
  return out;
}

}  // namespace rhexis::record::store
