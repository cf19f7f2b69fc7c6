#include "fracture/path.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "fracture/cut_geometry.h"
#include "fracture/front.h"

namespace rhexis::fracture {
namespace {

/// A segment of a front that has moved keeps at least this part of its length, along itself.
constexpr double kLeastSegment = 0.25;
/// Cosine of the largest angle between neighbouring segments of a front.
constexpr double kSharpestCorner = 0.5;
/// Steps are smoothed at least once, since neighbouring points see much the same tets and differ by their scatter ...
constexpr int kLeastSmoothings = 1;
/// ... and at most this often: then all take one step.
constexpr int kMostSmoothings = 50;
/// The crack goes on while a tet in the solve lies this far ahead of its front, in mean edges.
constexpr double kAheadEdges = 2.0;

double cosine(const Vec3& a, const Vec3& b) { return a.dot(b) / std::sqrt(a.squaredNorm() * b.squaredNorm()); }

/// No segment of the moved front turns back or shrinks to nothing, no corner comes to be sharp that was not so before.
bool is_regular(const std::vector<FrontPoint>& front, const std::vector<Vec3>& step) {
  const auto before = [&](std::size_t i) { return Vec3(front[i + 1].position - front[i].position); };
  const auto after = [&](std::size_t i) { return Vec3(before(i) + step[i + 1] - step[i]); };
  for (std::size_t i = 0; i + 1 < front.size(); ++i) {
    if (after(i).dot(before(i)) < kLeastSegment * before(i).squaredNorm()) return false;
    if (i > 0 && cosine(after(i - 1), after(i)) < std::min(kSharpestCorner, cosine(before(i - 1), before(i))))
      return false;
  }
  return true;
}

/// Moves each step towards the mean of its neighbours until the moved front is regular.
void smooth(const std::vector<FrontPoint>& front, std::vector<Vec3>& step) {
  for (int pass = 0; pass < kMostSmoothings; ++pass) {
    if (pass >= kLeastSmoothings && is_regular(front, step)) return;
    const std::vector<Vec3> old = step;
    for (std::size_t i = 0; i < step.size(); ++i) {
      const Vec3& left = old[i == 0 ? 0 : i - 1];
      const Vec3& right = old[std::min(i + 1, old.size() - 1)];
      step[i] = 0.25 * left + 0.5 * old[i] + 0.25 * right;
    }
  }
  Vec3 mean = Vec3::Zero();
  for (const Vec3& one : step) mean += one / static_cast<double>(step.size());
  std::fill(step.begin(), step.end(), mean);
}

void describe(const Crack& crack, Advance& advance) {
  advance.length = 0.0;
  advance.turn = 0.0;
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < advance.step.size(); ++i) {
    const double length = advance.step[i].norm();
    advance.length = std::max(advance.length, length);
    sum += advance.step[i];
    if (length > 0.0) {
      const double forward = std::clamp(advance.step[i].dot(crack.front[i].direction) / length, -1.0, 1.0);
      advance.turn = std::max(advance.turn, std::acos(forward));
    }
  }
  advance.angle = std::atan2(sum[1], sum[0]);
}

/// Makes every step longer by `by` m at the longest, the others in proportion; steps that have come to nothing, because
/// the ends went back to the surface where they were, go on in the present direction.
void lengthen(const Crack& crack, Advance& advance, double by) {
  const double factor = advance.length > 0.0 ? (advance.length + by) / advance.length : 0.0;
  for (std::size_t i = 0; i < advance.step.size(); ++i)
    advance.step[i] = factor > 0.0 ? Vec3(factor * advance.step[i]) : Vec3(by * crack.front[i].direction);
}

/// Ends each step at the first flank of another crack that it crosses. From a little behind the front, so that a point
/// that has got there stays.
void stop_at_flanks(const Crack& crack, Advance& advance, const mesh::TornMesh& body, const CutSurface& swept,
                    const IncisionSettings& settings) {
  const double edge = settings.mean_edge;
  const CutGeometry surface(swept.triangles, kOnPlane * edge);
  if (surface.triangles().empty()) return;
  const CutGeometry flanks = surface.others(body.history(), edge);
  if (flanks.triangles().empty()) return;
  std::size_t stopped = 0;
  for (std::size_t i = 0; i < crack.front.size(); ++i) {
    const Vec3& at = crack.front[i].position;
    Vec3& step = advance.step[i];
    const double length = step.norm();
    const Vec3 way = length > 0.0 ? Vec3(step / length) : crack.front[i].direction;
    const auto met = flanks.crossing(at - 2.0 * kIntoFlank * edge * way, at + step);
    if (!met) continue;
    ++stopped;
    const double allowed = std::clamp((met->at - at).dot(way) + kIntoFlank * edge, 0.0, length);
    step = allowed * way;
  }
  if (stopped == 0) return;
  if (crack.uniform) {
    const Vec3 whole =
        advance.step.front().norm() < advance.step.back().norm() ? advance.step.front() : advance.step.back();
    std::fill(advance.step.begin(), advance.step.end(), whole);
  }
  advance.stopped = crack.uniform || stopped == crack.front.size();
  describe(crack, advance);
}

std::vector<FrontPoint> moved_front(const Crack& crack, const Advance& advance) {
  std::vector<FrontPoint> front = crack.front;
  for (std::size_t i = 0; i < front.size(); ++i) {
    front[i].position += advance.step[i];
    const double length = advance.step[i].norm();
    if (length > 0.0) front[i].direction = advance.step[i] / length;
  }
  return front;
}

bool has_left(const Crack& crack, const Advance& advance, const Surroundings& surroundings) {
  const std::vector<FrontPoint> front = moved_front(crack, advance);
  for (std::size_t i = 0; i + 1 < front.size(); ++i)
    if (!surroundings.inside(front[i].position, front[i + 1].position).empty()) return false;
  return true;
}

bool has_nothing_ahead(const Crack& crack, const Surroundings& surroundings, const mesh::TornMesh& body) {
  for (const TetId tet : surroundings.tets_near(body, crack, kAheadEdges * surroundings.mean_edge())) {
    const std::array<Vec3, 4> x = mesh::corners(body.mesh(), tet);
    const Vec3 centroid = 0.25 * (x[0] + x[1] + x[2] + x[3]);
    for (const FrontPoint& point : crack.front)
      if ((centroid - point.position).dot(point.direction) > 0.0) return false;
  }
  return true;
}

/// Part of the way from `a` to `b` that lies in the intact body.
double share_inside(const Vec3& a, const Vec3& b, const Surroundings& surroundings) {
  double sum = 0.0;
  for (const Surroundings::Interval& part : surroundings.inside(a, b)) sum += part.to - part.from;
  return sum;
}

/// Of the swept surface inside the body, m^2: by strips between neighbouring points, each weighted by what its middle
/// has inside; its sides may run along the surface of the body, where inside is a matter of rounding.
double swept_area(const Crack& crack, const Advance& advance, const Surroundings& surroundings) {
  double area = 0.0;
  for (std::size_t i = 0; i + 1 < crack.front.size(); ++i) {
    const Vec3& a = crack.front[i].position;
    const Vec3& b = crack.front[i + 1].position;
    const Vec3 a_after = a + advance.step[i];
    const Vec3 b_after = b + advance.step[i + 1];
    const double strip = 0.5 * ((b - a).cross(a_after - a).norm() + (b_after - b).cross(b_after - a_after).norm());
    area += strip * share_inside(0.5 * (a + b), 0.5 * (a_after + b_after), surroundings);
  }
  return area;
}

}  // namespace

std::vector<FrontSection> front_sections(const Crack& crack, double mean_edge) {
  if (crack.uniform) return {{crack.front.front()}};
  std::vector<FrontSection> sections;
  for (std::size_t i = 0; i < crack.front.size(); ++i) {
    const auto length_to = [&](std::size_t other) {
      return (crack.front[other].position - crack.front[i].position).norm();
    };
    double widest = 2.0 * mean_edge;
    if (i > 0) widest = std::max(widest, length_to(i - 1));
    if (i + 1 < crack.front.size()) widest = std::max(widest, length_to(i + 1));
    sections.push_back({crack.front[i], 0.5 * widest});
  }
  return sections;
}

std::vector<Judgement> judge_front(const Criterion& criterion, const Crack& crack, double mean_edge,
                                   std::span<const TetStress> tets) {
  std::vector<Judgement> judgements;
  if (crack.finished) return judgements;
  for (const FrontSection& section : front_sections(crack, mean_edge))
    judgements.push_back(criterion.judge(section, tets));
  return judgements;
}

std::optional<Advance> plan_advance(const Crack& crack, std::span<const Judgement> judgements,
                                    const Surroundings& surroundings) {
  if (std::none_of(judgements.begin(), judgements.end(), [](const Judgement& one) { return one.met; }))
    return std::nullopt;
  RHEXIS_CHECK(judgements.size() == (crack.uniform ? 1 : crack.front.size()), "{} judgements for a front of {} points",
               judgements.size(), crack.front.size());
  Advance advance;
  for (std::size_t i = 0; i < crack.front.size(); ++i) {
    const Judgement& judgement = judgements[crack.uniform ? 0 : i];
    // A fitted value may reach the strength where no single tet reaches the lower threshold.
    const double length = judgement.length > 0.0 ? judgement.length : surroundings.mean_edge();
    advance.step.push_back(judgement.met ? Vec3(length * judgement.direction) : Vec3(Vec3::Zero()));
    if (judgement.met) advance.value = std::max(advance.value, judgement.value);
  }
  if (!crack.uniform) {
    smooth(crack.front, advance.step);
    end_on_surface(crack, advance.step, surroundings);
  }
  describe(crack, advance);
  return advance;
}

Advance imposed_advance(const Crack& crack, const Vec3& direction, double length, const Surroundings& surroundings) {
  Judgement said;
  said.met = true;
  said.direction = direction;
  said.length = length;
  const std::vector<Judgement> all(front_sections(crack, surroundings.mean_edge()).size(), said);
  return *plan_advance(crack, all, surroundings);
}

CutSurface sweep(const Crack& crack, const Advance& advance, double margin) {
  // Both fronts, longer at their ends by the margin, as strips of two triangles: (before, after) pairs along the front.
  std::vector<std::array<Vec3, 2>> rungs;
  const std::size_t last = crack.front.size() - 1;
  for (std::size_t i = 0; i <= last; ++i)
    rungs.push_back({crack.front[i].position, crack.front[i].position + advance.step[i]});
  std::array<Vec3, 2> beyond_first = rungs.front();
  std::array<Vec3, 2> beyond_last = rungs.back();
  for (std::size_t k = 0; k < 2; ++k) {
    beyond_first[k] += margin * (rungs[0][k] - rungs[1][k]).normalized();
    beyond_last[k] += margin * (rungs[last][k] - rungs[last - 1][k]).normalized();
  }
  rungs.insert(rungs.begin(), beyond_first);
  rungs.push_back(beyond_last);

  CutSurface surface;
  const auto add = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
    if ((b - a).cross(c - a).norm() > 0.0) surface.triangles.push_back({a, b, c});
  };
  for (std::size_t i = 0; i + 1 < rungs.size(); ++i) {
    add(rungs[i][0], rungs[i + 1][0], rungs[i + 1][1]);
    add(rungs[i][0], rungs[i + 1][1], rungs[i][1]);
  }
  return surface;
}

Incision cut_along(const mesh::TornMesh& body, const Surroundings& surroundings, const Crack& crack, Advance& advance,
                   const IncisionSettings& settings) {
  const double edge = surroundings.mean_edge();
  const auto cut = [&] {
    stop_at_flanks(crack, advance, body, sweep(crack, advance, kCutMargin * edge), settings);
    return incise(body, surroundings, sweep(crack, advance, kCutMargin * edge), settings);
  };
  Incision incision = cut();
  for (int longer = 0; longer < kMostLengthenings; ++longer) {
    if (!incision.edit.empty() || advance.stopped || has_left(crack, advance, surroundings)) break;
    lengthen(crack, advance, kLengthening * edge);
    if (!crack.uniform) end_on_surface(crack, advance.step, surroundings);
    describe(crack, advance);
    incision = cut();
  }
  return incision;
}

std::vector<Crack> advanced(const Crack& crack, const Advance& advance, const Surroundings& surroundings,
                            const mesh::TornMesh& body) {
  const std::vector<FrontPoint> front = moved_front(crack, advance);
  std::vector<Crack> cracks;
  if (!has_left(crack, advance, surroundings)) {
    if (crack.uniform)
      cracks.push_back({front, true, false, 0.0});
    else
      cracks = settle(front, surroundings);
  }
  if (cracks.empty()) cracks.push_back({front, crack.uniform, true, 0.0});
  cracks.front().area = crack.area + swept_area(crack, advance, surroundings);
  for (Crack& one : cracks)
    one.finished = one.finished || advance.stopped || has_nothing_ahead(one, surroundings, body);
  return cracks;
}

}  // namespace rhexis::fracture
