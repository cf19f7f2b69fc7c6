#include "mesh/plane_section.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "mesh/body_request.h"

namespace rhexis::mesh {
namespace {

constexpr double kPi = std::numbers::pi;
/// Enough for the angles to settle (their mean gains less than a tenth of a degree after it).
constexpr int kSweeps = 60;
/// Points begin this many edge lengths inside the rim.
constexpr double kInset = 0.5;

/// The edge length s at which equilateral triangles fill an area, given Euler's count of them: with P / s points on the
/// rim and `holes` holes, points make 2 points - 2 + 2 holes - P / s triangles.
double euler_edge(double area, double perimeter, int holes, int points) {
  const double a = 4.0 * area / std::sqrt(3.0);
  const double c = 2.0 * points - 2.0 + 2.0 * holes;
  return 2.0 * a / (-perimeter + std::sqrt(perimeter * perimeter + 4.0 * a * c));
}

int round_count(double count, int least) { return std::max(least, static_cast<int>(std::lround(count))); }

std::vector<Point2> regular_polygon(double radius, int corners, double turned_by) {
  std::vector<Point2> points;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2.0 * kPi * (i + turned_by) / corners;
    points.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
  }
  return points;
}

/// Points spread evenly over the area between two circles: the spiral of a sunflower's seeds, without its handedness.
std::vector<Point2> sunflower(double from, double to, int count, double edge) {
  const double golden_angle = kPi * (3.0 - std::sqrt(5.0));
  const auto wobble = [&](int i, std::uint64_t which) {
    return 0.5 * edge * (hashed_fraction(static_cast<std::uint64_t>(i), which) - 0.5);
  };
  std::vector<Point2> points;
  for (int i = 0; i < count; ++i) {
    const double share = (i + 0.5) / count;
    const double spiral = std::sqrt(from * from + share * (to * to - from * from));
    const double radius = std::clamp(spiral + wobble(i, 1), from, to);
    const double angle = golden_angle * i + wobble(i, 2) / std::max(spiral, edge);
    points.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
  }
  return points;
}

/// Exactly `count` points in [0, a] x [0, b]: rows of boxes of equal area, one point anywhere in each.
std::vector<Point2> scattered(double a, double b, int count) {
  const int rows = std::clamp(static_cast<int>(std::lround(std::sqrt(count * b / a))), 1, count);
  std::vector<Point2> points;
  for (int row = 0; row < rows; ++row) {
    const auto before = [&](int r) { return static_cast<int>(std::int64_t{r} * count / rows); };
    const int in_row = before(row + 1) - before(row);
    for (int i = 0; i < in_row; ++i) {
      const std::uint64_t seed = points.size();
      points.emplace_back(a * (i + hashed_fraction(seed, 1)) / in_row, b * (row + hashed_fraction(seed, 2)) / rows);
    }
  }
  return points;
}

/// Inserts and smooths. The triangulation is in units of `edge`; the rim is handed over once more, in metres, because
/// scaling forth and back would not return the same bits.
PlaneMesh fill(Triangulation triangulation, const std::vector<Point2>& inside, double edge,
               const std::vector<Point2>& outer, const std::vector<Point2>& inner) {
  for (const Point2& point : inside) triangulation.insert(point);
  triangulation.smooth(kSweeps);
  PlaneMesh mesh{triangulation.points(), triangulation.triangles(), {}};
  for (Point2& point : mesh.points) point *= edge;
  std::copy(outer.begin(), outer.end(), mesh.points.begin());
  std::copy(inner.begin(), inner.end(), mesh.points.begin() + static_cast<std::ptrdiff_t>(outer.size()));
  mesh.rim.assign(mesh.points.size(), Rim::none);
  std::fill_n(mesh.rim.begin(), outer.size(), Rim::outer);
  std::fill_n(mesh.rim.begin() + static_cast<std::ptrdiff_t>(outer.size()), inner.size(), Rim::inner);
  return mesh;
}

std::vector<Point2> scaled(std::vector<Point2> points, double factor) {
  for (Point2& point : points) point *= factor;
  return points;
}

/// Edges along the two sides of a rectangle.
std::array<int, 2> rectangle_edges(double a, double b, double edge) {
  return {round_count(a / edge, 2), round_count(b / edge, 2)};
}

int disc_edges(double radius, double edge) { return round_count(2.0 * kPi * radius / edge, 5); }

/// Edges around the outer and the inner line of an annulus. Without points between the two lines, they share all.
struct AnnulusCounts {
  int outer = 0;
  int inner = 0;
};
bool is_thin(double outer, double inner, double edge) { return outer - inner < 1.5 * edge * std::sqrt(0.75); }
AnnulusCounts annulus_edges(double outer, double inner, double edge, int points) {
  AnnulusCounts counts;
  counts.inner = round_count(2.0 * kPi * inner / edge, 5);
  counts.outer = is_thin(outer, inner, edge) ? points - counts.inner : round_count(2.0 * kPi * outer / edge, 5);
  return counts;
}

}  // namespace

std::optional<double> RectangleSection::edge_length(int points) const {
  if (points < 9) return std::nullopt;
  const double edge = euler_edge(a_ * b_, 2.0 * (a_ + b_), 0, points);
  if (!(std::max(a_, b_) / edge < points)) return std::nullopt;
  const auto [na, nb] = rectangle_edges(a_, b_, edge);
  if (2 * (na + nb) >= points) return std::nullopt;
  return edge;
}

PlaneMesh RectangleSection::mesh(int points) const {
  const double edge = edge_length(points).value();
  const auto [na, nb] = rectangle_edges(a_, b_, edge);
  std::vector<Point2> rim;
  for (int i = 0; i < na; ++i) rim.emplace_back(part_of(a_, i, na), 0.0);
  for (int i = 0; i < nb; ++i) rim.emplace_back(a_, part_of(b_, i, nb));
  for (int i = na; i > 0; --i) rim.emplace_back(part_of(a_, i, na), b_);
  for (int i = nb; i > 0; --i) rim.emplace_back(0.0, part_of(b_, i, nb));

  const Point2 inset(std::min(kInset * edge, 0.25 * a_), std::min(kInset * edge, 0.25 * b_));
  std::vector<Point2> inside =
      scattered(a_ - 2.0 * inset[0], b_ - 2.0 * inset[1], points - static_cast<int>(rim.size()));
  for (Point2& point : inside) point = (point + inset) / edge;
  Triangulation triangulation = Triangulation::fan(scaled(rim, 1.0 / edge), inside.front());
  inside.erase(inside.begin());
  return fill(std::move(triangulation), inside, edge, rim, {});
}

std::optional<double> DiscSection::edge_length(int points) const {
  if (points < 6) return std::nullopt;
  const double edge = euler_edge(kPi * radius_ * radius_, 2.0 * kPi * radius_, 0, points);
  if (disc_edges(radius_, edge) >= points) return std::nullopt;
  return edge;
}

PlaneMesh DiscSection::mesh(int points) const {
  const double edge = edge_length(points).value();
  const std::vector<Point2> rim = regular_polygon(radius_, disc_edges(radius_, edge), 0.0);
  const double middle = std::max(0.25 * radius_, radius_ - kInset * edge);
  std::vector<Point2> inside = scaled(sunflower(0.0, middle, points - static_cast<int>(rim.size()), edge), 1.0 / edge);
  Triangulation triangulation = Triangulation::fan(scaled(rim, 1.0 / edge), inside.front());
  inside.erase(inside.begin());
  return fill(std::move(triangulation), inside, edge, rim, {});
}

std::optional<double> AnnulusSection::edge_length(int points) const {
  if (points < 10) return std::nullopt;
  const double perimeter = 2.0 * kPi * (outer_ + inner_);
  double edge = euler_edge(kPi * (outer_ * outer_ - inner_ * inner_), perimeter, 1, points);
  if (is_thin(outer_, inner_, edge)) edge = perimeter / points;
  const auto [n_outer, n_inner] = annulus_edges(outer_, inner_, edge, points);
  if (n_outer < 5 || n_outer + n_inner > points) return std::nullopt;
  // The chords of the outer circle must stay clear of the inner one, or the wall would have holes.
  const double sagitta = outer_ * (1.0 - std::cos(kPi / n_outer));
  if (sagitta > 0.25 * (outer_ - inner_)) return std::nullopt;
  return edge;
}

PlaneMesh AnnulusSection::mesh(int points) const {
  const double edge = edge_length(points).value();
  const auto [n_outer, n_inner] = annulus_edges(outer_, inner_, edge, points);
  const std::vector<Point2> outer = regular_polygon(outer_, n_outer, 0.0);
  const std::vector<Point2> inner = regular_polygon(inner_, n_inner, 0.5);
  const double inset = std::min(kInset * edge, 0.25 * (outer_ - inner_));
  const std::vector<Point2> inside = sunflower(inner_ + inset, outer_ - inset, points - n_outer - n_inner, edge);
  return fill(Triangulation::ring(scaled(outer, 1.0 / edge), scaled(inner, 1.0 / edge)), scaled(inside, 1.0 / edge),
              edge, outer, inner);
}

}  // namespace rhexis::mesh
