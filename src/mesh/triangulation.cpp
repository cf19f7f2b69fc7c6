#include "mesh/triangulation.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include <Eigen/Dense>

#include "base/check.h"

namespace rhexis::mesh {
namespace {

/// Twice the area below which a triangle counts as degenerate; one of the wanted size has 0.87.
constexpr double kLeastArea2 = 1e-6;
/// A flip has to gain this share of the terms of the in-circle test; their rounding is a thousand times smaller, so
/// flips cannot go round in circles.
constexpr double kLeastGain = 1e-12;

double cross(const Point2& a, const Point2& b) { return a[0] * b[1] - a[1] * b[0]; }

/// Does d lie inside the circle through a, b, c (counter-clockwise), beyond doubt?
bool in_circle(const Point2& a, const Point2& b, const Point2& c, const Point2& d) {
  const Point2 u = a - d;
  const Point2 v = b - d;
  const Point2 w = c - d;
  const auto terms = [](const Point2& p, const Point2& q) { return std::abs(p[0] * q[1]) + std::abs(p[1] * q[0]); };
  const double uu = u.squaredNorm();
  const double vv = v.squaredNorm();
  const double ww = w.squaredNorm();
  return uu * cross(v, w) + vv * cross(w, u) + ww * cross(u, v) >
         kLeastGain * (uu * terms(v, w) + vv * terms(w, u) + ww * terms(u, v));
}

Point2 circumcentre(const Point2& a, const Point2& b, const Point2& c) {
  const Point2 u = b - a;
  const Point2 v = c - a;
  const Point2 offset(v[1] * u.squaredNorm() - u[1] * v.squaredNorm(), u[0] * v.squaredNorm() - v[0] * u.squaredNorm());
  return a + offset / (2.0 * cross(u, v));
}

double turned_angle(const Point2& p) {
  const double angle = std::atan2(p[1], p[0]);
  return angle < 0.0 ? angle + 2.0 * std::numbers::pi : angle;
}

}  // namespace

Triangulation Triangulation::fan(std::vector<Point2> rim, const Point2& inside) {
  Triangulation result(std::move(rim));
  const int n = static_cast<int>(result.points_.size());
  result.points_.push_back(inside);
  for (int i = 0; i < n; ++i) result.triangles_.push_back({i, (i + 1) % n, n});
  result.connect();
  result.flip_everywhere();
  return result;
}

Triangulation Triangulation::ring(std::vector<Point2> outer, const std::vector<Point2>& inner) {
  const int n_outer = static_cast<int>(outer.size());
  const int n_inner = static_cast<int>(inner.size());
  RHEXIS_CHECK(n_outer >= 3 && n_inner >= 3, "lines of {} and {} points close no ring", n_outer, n_inner);
  const auto angle = [](const std::vector<Point2>& line, int i) {
    const int n = static_cast<int>(line.size());
    return turned_angle(line[static_cast<std::size_t>(i % n)]) + (i >= n ? 2.0 * std::numbers::pi : 0.0);
  };
  // Both lines are walked together; the one whose next point comes first makes the next triangle.
  std::vector<Triangle> triangles;
  for (int o = 0, i = 0; o < n_outer || i < n_inner;) {
    const bool step_outer = i == n_inner || (o < n_outer && angle(outer, o + 1) < angle(inner, i + 1));
    const int at_outer = o % n_outer;
    const int at_inner = n_outer + i % n_inner;
    if (step_outer)
      triangles.push_back({at_outer, (++o) % n_outer, at_inner});
    else
      triangles.push_back({at_outer, n_outer + (++i) % n_inner, at_inner});
  }
  outer.insert(outer.end(), inner.begin(), inner.end());
  Triangulation result(std::move(outer));
  result.triangles_ = std::move(triangles);
  result.connect();
  result.flip_everywhere();
  return result;
}

void Triangulation::connect() {
  std::map<std::pair<int, int>, std::pair<std::size_t, std::size_t>> open;
  neighbours_.assign(triangles_.size(), {-1, -1, -1});
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    const auto& [a, b, c] = triangles_[t];
    RHEXIS_CHECK(area2(a, b, c) > 0.0, "triangle {} {} {} of the first triangulation is not counter-clockwise", a, b,
                 c);
    for (std::size_t k = 0; k < 3; ++k) {
      const int from = triangles_[t][(k + 1) % 3];
      const int to = triangles_[t][(k + 2) % 3];
      if (const auto other = open.find({to, from}); other != open.end()) {
        neighbours_[t][k] = static_cast<int>(other->second.first);
        neighbours_[other->second.first][other->second.second] = static_cast<int>(t);
      } else {
        open[{from, to}] = {t, k};
      }
    }
  }
}

double Triangulation::area2(int a, int b, int c) const {
  const auto at = [&](int i) -> const Point2& { return points_[static_cast<std::size_t>(i)]; };
  return cross(at(b) - at(a), at(c) - at(a));
}

/// The triangle that holds the point: a walk towards it from the last one, and where the walk meets the rim (a hole
/// may lie in the way) a search through all.
std::size_t Triangulation::locate(const Point2& point) const {
  const auto least_side = [&](std::size_t t) {
    std::pair<double, std::size_t> least{0.0, 0};
    for (std::size_t k = 0; k < 3; ++k) {
      const Point2& from = points_[static_cast<std::size_t>(triangles_[t][(k + 1) % 3])];
      const Point2& to = points_[static_cast<std::size_t>(triangles_[t][(k + 2) % 3])];
      const double side = cross(to - from, point - from);
      if (k == 0 || side < least.first) least = {side, k};
    }
    return least;
  };
  std::size_t t = last_;
  for (std::size_t step = 0; step < triangles_.size(); ++step) {
    const auto [side, k] = least_side(t);
    if (side >= 0.0) return t;
    if (neighbours_[t][k] < 0) break;
    t = static_cast<std::size_t>(neighbours_[t][k]);
  }
  std::size_t best = 0;
  for (std::size_t i = 1; i < triangles_.size(); ++i)
    if (least_side(i).first > least_side(best).first) best = i;
  return best;
}

void Triangulation::insert(Point2 point) {
  const std::size_t t = locate(point);
  const Triangle old = triangles_[t];
  const std::array<int, 3> across = neighbours_[t];
  const auto at = [&](int i) -> const Point2& { return points_[static_cast<std::size_t>(i)]; };
  const Point2 middle = (at(old[0]) + at(old[1]) + at(old[2])) / 3.0;
  const auto is_inside = [&] {
    for (std::size_t k = 0; k < 3; ++k)
      if (cross(at(old[(k + 1) % 3]) - at(old[k]), point - at(old[k])) < kLeastArea2) return false;
    return true;
  };
  for (int tries = 0; tries < 8 && !is_inside(); ++tries) point = 0.5 * (point + middle);

  // Triangle t becomes the one at edge 2 (vertices 0, 1), the two others are new.
  const int p = static_cast<int>(points_.size());
  const int t0 = static_cast<int>(t);
  const int t1 = static_cast<int>(triangles_.size());
  const int t2 = t1 + 1;
  points_.push_back(point);
  triangles_[t] = {old[0], old[1], p};
  triangles_.push_back({old[1], old[2], p});
  triangles_.push_back({old[2], old[0], p});
  neighbours_[t] = {t1, t2, across[2]};
  neighbours_.push_back({t2, t0, across[0]});
  neighbours_.push_back({t0, t1, across[1]});
  replace_neighbour(across[0], t0, t1);
  replace_neighbour(across[1], t0, t2);
  last_ = t;
  flip_around({{t, 2}, {static_cast<std::size_t>(t1), 2}, {static_cast<std::size_t>(t2), 2}});
}

void Triangulation::replace_neighbour(int triangle, int old_neighbour, int new_neighbour) {
  if (triangle < 0) return;
  auto& around = neighbours_[static_cast<std::size_t>(triangle)];
  *std::find(around.begin(), around.end(), old_neighbour) = new_neighbour;
}

/// Is the edge opposite to vertex k of triangle t worse than the other diagonal of the quadrilateral around it?
bool Triangulation::wants_flip(std::size_t t, std::size_t k) const {
  const int other = neighbours_[t][k];
  if (other < 0) return false;
  const auto& back = neighbours_[static_cast<std::size_t>(other)];
  const auto j = static_cast<std::size_t>(std::find(back.begin(), back.end(), static_cast<int>(t)) - back.begin());
  const int a = triangles_[t][k];
  const int b = triangles_[t][(k + 1) % 3];
  const int c = triangles_[t][(k + 2) % 3];
  const int d = triangles_[static_cast<std::size_t>(other)][j];
  const auto at = [&](int i) -> const Point2& { return points_[static_cast<std::size_t>(i)]; };
  return in_circle(at(a), at(b), at(c), at(d)) && area2(a, b, d) > kLeastArea2 && area2(a, d, c) > kLeastArea2;
}

/// Triangles (a, b, c) and (d, c, b) become (a, b, d) and (d, c, a): vertices a and d keep their places.
void Triangulation::flip(std::size_t t, std::size_t k) {
  const auto n = static_cast<std::size_t>(neighbours_[t][k]);
  const auto j = static_cast<std::size_t>(std::find(neighbours_[n].begin(), neighbours_[n].end(), static_cast<int>(t)) -
                                          neighbours_[n].begin());
  const std::size_t kb = (k + 1) % 3;
  const std::size_t kc = (k + 2) % 3;
  const std::size_t jc = (j + 1) % 3;
  const std::size_t jb = (j + 2) % 3;
  const int beyond_ac = neighbours_[t][kb];  // opposite to b: edge (c, a)
  const int beyond_db = neighbours_[n][jc];  // opposite to c: edge (b, d)
  triangles_[t][kc] = triangles_[n][j];
  triangles_[n][jb] = triangles_[t][k];
  neighbours_[t][k] = beyond_db;
  neighbours_[t][kb] = static_cast<int>(n);
  neighbours_[n][j] = beyond_ac;
  neighbours_[n][jc] = static_cast<int>(t);
  replace_neighbour(beyond_db, static_cast<int>(n), static_cast<int>(t));
  replace_neighbour(beyond_ac, static_cast<int>(t), static_cast<int>(n));
}

void Triangulation::flip_around(std::vector<std::pair<std::size_t, std::size_t>> suspects) {
  while (!suspects.empty()) {
    const auto [t, k] = suspects.back();
    suspects.pop_back();
    if (!wants_flip(t, k)) continue;
    const auto n = static_cast<std::size_t>(neighbours_[t][k]);
    flip(t, k);
    for (std::size_t i = 0; i < 3; ++i) {
      suspects.emplace_back(t, i);
      suspects.emplace_back(n, i);
    }
  }
}

void Triangulation::flip_everywhere() {
  std::vector<std::pair<std::size_t, std::size_t>> suspects;
  for (std::size_t t = 0; t < triangles_.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      if (neighbours_[t][k] > static_cast<int>(t) && wants_flip(t, k)) suspects.emplace_back(t, k);
  flip_around(std::move(suspects));
}

void Triangulation::smooth(int sweeps) {
  std::vector<Point2> sum(points_.size());
  std::vector<double> weight(points_.size());
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    std::fill(sum.begin(), sum.end(), Point2::Zero());
    std::fill(weight.begin(), weight.end(), 0.0);
    for (const Triangle& triangle : triangles_) {
      const auto [a, b, c] = triangle;
      const double area = area2(a, b, c);
      const auto at = [&](int i) -> const Point2& { return points_[static_cast<std::size_t>(i)]; };
      const Point2 centre = circumcentre(at(a), at(b), at(c));
      for (const int i : triangle) {
        sum[static_cast<std::size_t>(i)] += area * centre;
        weight[static_cast<std::size_t>(i)] += area;
      }
    }
    const std::vector<Point2> before = points_;
    for (std::size_t i = rim_count_; i < points_.size(); ++i) points_[i] = sum[i] / weight[i];
    keep_upright(before);
    flip_everywhere();
  }
}

/// Takes back the moves of the corners of degenerate triangles, until there are none.
void Triangulation::keep_upright(const std::vector<Point2>& before) {
  for (bool taken_back = true; taken_back;) {
    taken_back = false;
    for (const auto& [a, b, c] : triangles_) {
      if (area2(a, b, c) > kLeastArea2) continue;
      for (const int i : {a, b, c}) {
        const auto at = static_cast<std::size_t>(i);
        taken_back = taken_back || points_[at] != before[at];
        points_[at] = before[at];
      }
    }
  }
}

}  // namespace rhexis::mesh
