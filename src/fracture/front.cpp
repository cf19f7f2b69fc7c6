#include "fracture/front.h"

#include <algorithm>
#include <cmath>

namespace rhexis::fracture {
namespace {

/// How far beyond its step the end of a front goes straight on to reach the surface, in mean edges.
constexpr double kStraightOn = 2.0;
/// Ends of neighbouring stretches are the same below this part of a segment.
constexpr double kSamePlace = 1e-6;

/// Where a moved end is to be; `inner` its neighbour. An end that has come out into a hole goes on to the far side of
/// what is beyond it: a front is as long as the body is there.
Vec3 end_at_surface(const Vec3& end, const Vec3& inner, double reach, const Surroundings& surroundings) {
  const Vec3 straight = reach * (end - inner).normalized();
  const auto parts = surroundings.inside(end, end + straight);
  if (parts.empty()) return end;  // outside, and nothing follows
  if (parts.front().to < 1.0 - kSamePlace) return end + parts.front().to * straight;
  return parts.front().from < kSamePlace ? surroundings.nearest_on_surface(end) : end;
}

FrontPoint between(const FrontPoint& a, const FrontPoint& b, double part) {
  FrontPoint point;
  point.position = a.position + part * (b.position - a.position);
  point.direction = (1.0 - part) * a.direction + part * b.direction;
  return point;
}

/// Points at equal distances along a polyline, about a mean edge apart.
std::vector<FrontPoint> resample(const std::vector<FrontPoint>& line, double length, double mean_edge) {
  const int segments = std::max(1, static_cast<int>(std::lround(length / mean_edge)));
  std::vector<FrontPoint> out{line.front()};
  std::size_t at = 0;
  double passed = 0.0;  // length of the line up to point `at`
  for (int i = 1; i < segments; ++i) {
    const double wanted = length * i / segments;
    double segment = (line[at + 1].position - line[at].position).norm();
    while (passed + segment < wanted && at + 2 < line.size()) {
      passed += segment;
      ++at;
      segment = (line[at + 1].position - line[at].position).norm();
    }
    const double part = segment > 0.0 ? std::clamp((wanted - passed) / segment, 0.0, 1.0) : 0.0;
    out.push_back(between(line[at], line[at + 1], part));
  }
  out.push_back(line.back());
  return out;
}

/// Tangents by the neighbours; directions made normal to them.
void orient(std::vector<FrontPoint>& front) {
  for (std::size_t i = 0; i < front.size(); ++i) {
    const Vec3& before = front[i == 0 ? 0 : i - 1].position;
    const Vec3& after = front[std::min(i + 1, front.size() - 1)].position;
    front[i].tangent = (after - before).normalized();
  }
  for (std::size_t i = 0; i < front.size(); ++i) {
    FrontPoint& point = front[i];
    Vec3 direction = point.direction - point.direction.dot(point.tangent) * point.tangent;
    if (direction.norm() < kSamePlace) {  // a direction along the front says nothing: the neighbour's, or any
      const Vec3& other = front[i == 0 ? 1 : i - 1].direction;
      direction = other - other.dot(point.tangent) * point.tangent;
      if (direction.norm() < kSamePlace) direction = point.tangent.unitOrthogonal();
    }
    point.direction = direction.normalized();
  }
}

double length_of(const std::vector<FrontPoint>& line) {
  double length = 0.0;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) length += (line[i + 1].position - line[i].position).norm();
  return length;
}

}  // namespace

void end_on_surface(const Crack& crack, std::vector<Vec3>& step, const Surroundings& surroundings) {
  const auto settle_end = [&](std::size_t end, std::size_t inner) {
    const double reach = kStraightOn * surroundings.mean_edge() + step[end].norm();
    const Vec3 at = crack.front[end].position + step[end];
    return Vec3(end_at_surface(at, crack.front[inner].position + step[inner], reach, surroundings) -
                crack.front[end].position);
  };
  const std::size_t last = crack.front.size() - 1;
  const Vec3 first_step = settle_end(0, 1);  // both from the front as it was: with two points each is the other's
  step[last] = settle_end(last, last - 1);
  step[0] = first_step;
}

std::vector<Crack> settle(const std::vector<FrontPoint>& front, const Surroundings& surroundings) {
  std::vector<std::vector<FrontPoint>> stretches;
  bool open = false;  // the last stretch ends at the end of the last segment
  for (std::size_t i = 0; i + 1 < front.size(); ++i) {
    bool reaches = false;
    for (const Surroundings::Interval& part : surroundings.inside(front[i].position, front[i + 1].position)) {
      if (!(open && part.from < kSamePlace)) stretches.push_back({between(front[i], front[i + 1], part.from)});
      open = false;
      stretches.back().push_back(between(front[i], front[i + 1], part.to));
      reaches = part.to > 1.0 - kSamePlace;
    }
    open = reaches;
  }
  std::vector<Crack> cracks;
  for (const auto& stretch : stretches) {
    const double length = length_of(stretch);
    if (length < kShortestFront * surroundings.mean_edge()) continue;
    Crack& crack = cracks.emplace_back();
    crack.front = resample(stretch, length, surroundings.mean_edge());
    orient(crack.front);
  }
  return cracks;
}

}  // namespace rhexis::fracture
