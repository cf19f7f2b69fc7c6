#include "studies/reaction_tally.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "record/store/parameters.h"

namespace rhexis::studies {
namespace {

/// Errors that differ by less than this part of the force are equal: what rounding leaves where both are zero.
constexpr double kTie = 1e-12;

/// m, in the plane of the frame.
double distance_from(const std::vector<Vec3>& path, const Vec3& point, const record::store::Frame& frame) {
  const auto flat = [&](const Vec3& v) { return Vec3(v - v.dot(frame.z) * frame.z); };
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    const Vec3 along = flat(path[i + 1] - path[i]);
    const Vec3 to = flat(point - path[i]);
    const double part = along.isZero(0.0) ? 0.0 : std::clamp(to.dot(along) / along.squaredNorm(), 0.0, 1.0);
    least = std::min(least, (to - part * along).norm());
  }
  return least;
}

}  // namespace

void Moments::add(double value) {
  ++count;
  sum += value;
  squares += value * value;
  largest = std::max(largest, value);
}

void Moments::merge(const Moments& other) {
  count += other.count;
  sum += other.sum;
  squares += other.squares;
  largest = std::max(largest, other.largest);
}

double Moments::deviation() const {
  const double n = static_cast<double>(count);
  return std::sqrt(std::max(0.0, squares / n - (sum / n) * (sum / n)));
}

void WayTally::merge(const WayTally& other) {
  error.merge(other.error);
  relative.merge(other.relative);
  better += other.better;
  tied += other.tied;
}

void ReactionTally::merge(const ReactionTally& other) {
  const auto add = [](Ways& to, const Ways& from) {
    for (std::size_t k = 0; k < to.size(); ++k) to[k].merge(from[k]);
  };
  add(all, other.all);
  torn_off += other.torn_off;
  for (const auto& [key, ways] : other.angle) add(angle[key], ways);
  for (const auto& [key, ways] : other.distance) add(distance[key], ways);
}

std::vector<Vec3> recorded_pulls(const record::store::Frame& frame) {
  const record::store::Parameters parameters;
  std::vector<Vec3> out;
  for (const double angle : record::store::pull_angles(parameters))
    out.emplace_back(parameters.pull_length * frame.direction(angle));
  return out;
}

void count_errors(const ReactionQuery& query, const std::vector<Vec3>& pulls, const std::vector<Vec3>& points,
                  const record::store::Frame& frame, ReactionTally& tally) {
  tally.torn_off += query.torn_off * static_cast<std::int64_t>(pulls.size());
  Ways& of_angle = tally.angle[query.angles.back()];
  for (const ReactionSample& sample : query.samples) {
    const std::array<Mat3, kReactionWays.size()> off{sample.nearest - sample.exact, sample.linear - sample.exact,
                                                     sample.local - sample.exact};
    Ways ways;
    for (const Vec3& pull : pulls) {
      const double force = (sample.exact * pull).norm();
      const double of_nearest = (off[0] * pull).norm();
      for (std::size_t k = 0; k < off.size(); ++k) {
        const double error = k == 0 ? of_nearest : (off[k] * pull).norm();
        ways[k].error.add(error);
        ways[k].relative.add(error / force);
        const bool tied = std::abs(error - of_nearest) <= kTie * force;
        ways[k].tied += tied ? 1 : 0;
        ways[k].better += !tied && error < of_nearest ? 1 : 0;
      }
    }
    Ways& of_distance =
        tally.distance[static_cast<int>(distance_from(query.path, points[sample.point], frame) / kDistanceClass)];
    for (std::size_t k = 0; k < ways.size(); ++k) {
      tally.all[k].merge(ways[k]);
      of_angle[k].merge(ways[k]);
      of_distance[k].merge(ways[k]);
    }
  }
}

}  // namespace rhexis::studies
