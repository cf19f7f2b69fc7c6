#include "mesh/triangulation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include <Eigen/Dense>

#include "mesh/body_request.h"
#include "mesh/plane_section.h"

namespace rhexis::mesh {
namespace {

std::vector<Point2> square(int n) {
  std::vector<Point2> rim;
  for (int i = 0; i < n; ++i) rim.emplace_back(i, 0);
  for (int i = 0; i < n; ++i) rim.emplace_back(n, i);
  for (int i = 0; i < n; ++i) rim.emplace_back(n - i, n);
  for (int i = 0; i < n; ++i) rim.emplace_back(0, n - i);
  return rim;
}

std::vector<Point2> circle(double radius, int n) {
  std::vector<Point2> points;
  for (int i = 0; i < n; ++i)
    points.emplace_back(radius * std::cos(2.0 * std::numbers::pi * i / n),
                        radius * std::sin(2.0 * std::numbers::pi * i / n));
  return points;
}

Point2 noise(std::uint64_t i, double size) { return {size * hashed_fraction(i, 1), size * hashed_fraction(i, 2)}; }

double twice_area(const Point2& a, const Point2& b, const Point2& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

double area(const Triangulation& triangulation) {
  double sum = 0.0;
  for (const auto& t : triangulation.triangles()) {
    const auto at = [&](std::size_t k) { return triangulation.points()[static_cast<std::size_t>(t[k])]; };
    EXPECT_GT(twice_area(at(0), at(1), at(2)), 0.0);
    sum += 0.5 * twice_area(at(0), at(1), at(2));
  }
  return sum;
}

/// No point in the circle of any triangle, by looking at all pairs; the tolerance is relative to the circle.
void expect_delaunay(const Triangulation& triangulation) {
  const auto& points = triangulation.points();
  for (const auto& t : triangulation.triangles()) {
    const Point2& a = points[static_cast<std::size_t>(t[0])];
    Eigen::Matrix2d sides;
    sides.row(0) = (points[static_cast<std::size_t>(t[1])] - a).transpose();
    sides.row(1) = (points[static_cast<std::size_t>(t[2])] - a).transpose();
    const Point2 centre = sides.fullPivLu().solve(0.5 * sides.rowwise().squaredNorm());
    for (const Point2& p : points) EXPECT_GT((p - a - centre).norm(), centre.norm() * (1.0 - 1e-6));
  }
}

TEST(Triangulation, IsDelaunayAndFillsTheSquare) {
  Triangulation triangulation = Triangulation::fan(square(6), noise(0, 6.0));
  for (std::uint64_t i = 1; i < 60; ++i) triangulation.insert(noise(i, 6.0));
  EXPECT_NEAR(area(triangulation), 36.0, 1e-12);
  // Euler: 2 points - 2 - rim.
  EXPECT_EQ(triangulation.triangles().size(), 2u * 84u - 2u - 24u);
  expect_delaunay(triangulation);
}

TEST(Triangulation, SmoothingKeepsRimAreaAndDelaunayAndWidensAngles) {
  Triangulation triangulation = Triangulation::fan(square(6), noise(0, 6.0));
  for (std::uint64_t i = 1; i < 30; ++i) triangulation.insert(noise(i, 6.0));
  const auto least_angle = [&] {
    double least = 180.0;
    for (const auto& t : triangulation.triangles())
      for (std::size_t k = 0; k < 3; ++k) {
        const auto at = [&](std::size_t j) { return triangulation.points()[static_cast<std::size_t>(t[j % 3])]; };
        const Point2 u = at(k + 1) - at(k);
        const Point2 v = at(k + 2) - at(k);
        least = std::min(least, std::acos(u.dot(v) / u.norm() / v.norm()) * 180.0 / std::numbers::pi);
      }
    return least;
  };
  EXPECT_LT(least_angle(), 15.0);
  triangulation.smooth(60);
  EXPECT_GT(least_angle(), 27.0);
  EXPECT_NEAR(area(triangulation), 36.0, 1e-12);
  const auto rim = square(6);
  EXPECT_TRUE(std::equal(rim.begin(), rim.end(), triangulation.points().begin()));
  expect_delaunay(triangulation);
}

TEST(Triangulation, RingHasItsHole) {
  for (const int inner : {5, 12, 40}) {
    const auto outer_line = circle(4.0, 24);
    const auto inner_line = circle(3.0, inner);
    Triangulation triangulation = Triangulation::ring(outer_line, inner_line);
    const auto polygon = [](double r, int n) { return 0.5 * n * r * r * std::sin(2.0 * std::numbers::pi / n); };
    const double expected = polygon(4.0, 24) - polygon(3.0, inner);
    EXPECT_NEAR(area(triangulation), expected, 1e-12);
    EXPECT_EQ(triangulation.triangles().size(), 24u + static_cast<std::size_t>(inner));
    // Points on opposite sides of the hole, so that the search for their triangles has to get around it.
    for (int i = 0; i < 12; ++i) {
      const double angle = 2.4 * i;
      triangulation.insert(Point2(3.4 * std::cos(angle), 3.4 * std::sin(angle)));
    }
    triangulation.smooth(20);
    EXPECT_NEAR(area(triangulation), expected, 1e-12);
    EXPECT_EQ(triangulation.triangles().size(), 24u + static_cast<std::size_t>(inner) + 24u);
  }
}

TEST(Triangulation, SurvivesPointsOnEdgesAndOnPoints) {
  Triangulation triangulation = Triangulation::fan(square(2), Point2(1.0, 1.0));
  for (const Point2& p : {Point2(0.5, 0.5), Point2(1.0, 0.5), Point2(1.0, 1.0), Point2(1.0, 1.0), Point2(1.5, 1.5)})
    triangulation.insert(p);
  EXPECT_NEAR(area(triangulation), 4.0, 1e-12);  // and every triangle has a positive one
  triangulation.smooth(10);
  EXPECT_NEAR(area(triangulation), 4.0, 1e-12);
}

TEST(Triangulation, LatticePointsWithManyOnOneCircleEndTheFlips) {
  Triangulation triangulation = Triangulation::fan(square(8), Point2(4.0, 4.0));
  for (int j = 1; j < 8; ++j)
    for (int i = 1; i < 8; ++i)
      if (i != 4 || j != 4) triangulation.insert(Point2(i, j));
  EXPECT_NEAR(area(triangulation), 64.0, 1e-12);
  expect_delaunay(triangulation);
}

TEST(PlaneSection, HasThePointsAskedFor) {
  const RectangleSection rectangle(2.0, 1.0);
  const DiscSection disc(1.0);
  const AnnulusSection wall(1.0, 0.8);
  const AnnulusSection thick(1.0, 0.2);
  for (const PlaneSection* section : std::initializer_list<const PlaneSection*>{&rectangle, &disc, &wall, &thick})
    for (const int points : {40, 63, 100, 257, 1000}) {
      ASSERT_TRUE(section->edge_length(points).has_value()) << points;
      const PlaneMesh mesh = section->mesh(points);
      EXPECT_EQ(mesh.points.size(), static_cast<std::size_t>(points));
      EXPECT_EQ(mesh.rim.size(), mesh.points.size());
      std::set<int> used;
      for (const Triangle& t : mesh.triangles) used.insert(t.begin(), t.end());
      EXPECT_EQ(used.size(), mesh.points.size());
    }
}

TEST(PlaneSection, EdgeLengthIsWhatTheTrianglesHave) {
  const DiscSection disc(1.0);
  const PlaneMesh mesh = disc.mesh(400);
  double sum = 0.0;
  for (const Triangle& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k)
      sum +=
          (mesh.points[static_cast<std::size_t>(t[k])] - mesh.points[static_cast<std::size_t>(t[(k + 1) % 3])]).norm();
  EXPECT_NEAR(sum / (3.0 * static_cast<double>(mesh.triangles.size())), disc.edge_length(400).value(),
              0.03 * disc.edge_length(400).value());
}

TEST(PlaneSection, TooFewPointsHaveNoEdgeLength) {
  EXPECT_FALSE(RectangleSection(1.0, 1.0).edge_length(8).has_value());
  EXPECT_FALSE(DiscSection(1.0).edge_length(5).has_value());
  EXPECT_FALSE(AnnulusSection(1.0, 0.99).edge_length(30).has_value()) << "the chords would cut through the wall";
  EXPECT_TRUE(AnnulusSection(1.0, 0.99).edge_length(100).has_value());
}

}  // namespace
}  // namespace rhexis::mesh
