#include <gmock/gmock.h>

#include <limits>
#include <numbers>

#include "tests/mesh/generate_support.h"

namespace rhexis::mesh {
namespace {

constexpr double kPi = std::numbers::pi;

/// Nodes of a set that lie on the bottom cut: the corners of the polygon that stands for a circle.
int corners_at_bottom(const TetMesh& mesh, const char* set) {
  const auto& bottom = mesh.find_node_set("bottom")->nodes;
  int count = 0;
  for (const NodeId n : mesh.find_node_set(set)->nodes) count += std::binary_search(bottom.begin(), bottom.end(), n);
  return count;
}

double polygon_area(double radius, int corners) {
  return 0.5 * corners * radius * radius * std::sin(2.0 * kPi / corners);
}

struct TubeCase {
  TubeShape shape;
  int nodes;
};

class Tube : public testing::TestWithParam<TubeCase> {};

TEST_P(Tube, HasItsFormSetsAndShape) {
  const auto& [shape, nodes] = GetParam();
  const auto made = make_tube(shape, nodes);
  ASSERT_TRUE(made.has_value()) << made.error().message();
  const TetMesh& mesh = *made;
  EXPECT_NEAR(static_cast<double>(mesh.node_count()), nodes, 0.02 * nodes);
  expect_sound(mesh);
  EXPECT_EQ(mesh.face_sets.size(), shape.wall > 0.0 ? 4u : 3u);

  const int outer_corners = corners_at_bottom(mesh, "outer");
  double section = polygon_area(shape.radius, outer_corners);
  if (shape.wall > 0.0) section -= polygon_area(shape.radius - shape.wall, corners_at_bottom(mesh, "inner"));
  EXPECT_NEAR(area_of(mesh, mesh.find_face_set("bottom")->faces), section, 1e-12 * section);
  EXPECT_NEAR(area_of(mesh, mesh.find_face_set("top")->faces), section, 1e-12 * section);
  for (const NodeId n : mesh.find_node_set("bottom")->nodes) EXPECT_EQ(mesh.node(n)[2], 0.0);

  const double volume = section * shape.length;  // Pappus, when bent, for layers without end
  if (shape.bend == 0.0) {
    EXPECT_NEAR(total_volume(mesh), volume, 1e-12 * volume);
    const double side = 2.0 * shape.radius * std::sin(kPi / outer_corners) * outer_corners * shape.length;
    EXPECT_NEAR(area_of(mesh, mesh.find_face_set("outer")->faces), side, 1e-12 * side);
  } else {
    EXPECT_NEAR(total_volume(mesh), volume, 0.02 * volume);
  }
  const Quality quality = measure_quality(mesh);
  EXPECT_GT(quality.dihedral.min, 18.0);
  EXPECT_GT(quality.radius_ratio.mean, 0.7);
}

INSTANTIATE_TEST_SUITE_P(Shapes, Tube,
                         testing::Values(TubeCase{{}, 50}, TubeCase{{}, 401}, TubeCase{{}, 3000}, TubeCase{{}, 30000},
                                         TubeCase{{.bend = 90.0}, 401}, TubeCase{{.bend = -90.0}, 3000},
                                         TubeCase{{.bend = 90.0}, 30000}, TubeCase{{.wall = 0.0015}, 401},
                                         TubeCase{{.wall = 0.0015}, 3000}, TubeCase{{.wall = 0.0015}, 30000},
                                         TubeCase{{.wall = 0.0015, .bend = 60.0}, 3000},
                                         TubeCase{{.wall = 0.004}, 5000},
                                         TubeCase{{.radius = 1.0, .length = 1.0, .wall = 0.3}, 3000}));

TEST(Tube, HasNoPreferredDiagonal) {
  expect_no_preferred_diagonal(make_tube({}, 3000).value());
  expect_no_preferred_diagonal(make_tube({.wall = 0.0015}, 3000).value());
}

TEST(Tube, WallTubeHasAboutTheCountsOfThePapersVessel) {
  // 401 nodes, 1101 tets in a box of 10 x 10 x 40 mm.
  const TetMesh mesh = make_tube({.radius = 0.005, .length = 0.04, .wall = 0.0015}, 401).value();
  EXPECT_NEAR(static_cast<double>(mesh.node_count()), 401, 0.02 * 401);
  EXPECT_NEAR(static_cast<double>(mesh.tet_count()), 1101, 0.04 * 1101);
}

TEST(Tube, BendTurnsTheTopAboutItsAxis) {
  const TubeShape shape{.radius = 0.005, .length = 0.04, .bend = 90.0};
  const TetMesh mesh = make_tube(shape, 3000).value();
  // A quarter turn: the top cut stands across x, the centre line ends one bend radius up and one to the side.
  const double bend_radius = shape.length / (0.5 * kPi);
  Vec3 middle = Vec3::Zero();
  const auto& top = mesh.find_node_set("top")->nodes;
  for (const NodeId n : top) {
    EXPECT_NEAR(mesh.node(n)[0], bend_radius, 1e-15);
    middle += mesh.node(n) / static_cast<double>(top.size());
  }
  EXPECT_NEAR(middle[2], bend_radius, 1e-4);
  EXPECT_NEAR(middle[1], 0.0, 1e-4);
}

TEST(Tube, SlightBendIsCloseToNone) {
  const TetMesh straight = make_tube({}, 3000).value();
  const TetMesh bent = make_tube({.bend = 1e-9}, 3000).value();
  ASSERT_EQ(straight.node_count(), bent.node_count());
  // 1e-9 degrees over 0.04 m move the top by 3.5e-13 m.
  for (std::size_t i = 0; i < bent.node_count(); ++i) EXPECT_LT((bent.nodes[i] - straight.nodes[i]).norm(), 1e-12);
}

TEST(Tube, BentVolumeConvergesToPappus) {
  const auto error = [](int nodes) {
    const TubeShape shape{.radius = 0.005, .length = 0.04, .bend = 120.0};
    return 1.0 - total_volume(make_tube(shape, nodes).value()) / (kPi * shape.radius * shape.radius * shape.length);
  };
  // Facets cut off a share of h^2, and h^3 goes with one over the node count: 27 times the nodes, a ninth of the error.
  const double coarse = error(1000);
  const double fine = error(27000);
  EXPECT_GT(fine, 0.0);
  EXPECT_NEAR(coarse / fine, 9.0, 2.5);
}

TEST(Tube, EveryCountCanBeHad) {
  // A thin wall takes some more nodes to begin with: less would be drawn out more than ten times.
  for (const auto& [shape, fewest] : {TubeCase{{}, 50}, TubeCase{{.wall = 0.0015}, 100}})
    for (int nodes = fewest; nodes < 1200; nodes += nodes < 200 ? 1 : 7) {
      const auto mesh = make_tube(shape, nodes);
      ASSERT_TRUE(mesh.has_value()) << mesh.error().message();
      ASSERT_NEAR(static_cast<double>(mesh->node_count()), nodes, 0.02 * nodes);
      ASSERT_TRUE(find_defects(*mesh).empty()) << nodes;
    }
}

TEST(Tube, IsTheSameEveryTime) {
  const TubeShape shape{.wall = 0.002, .bend = 30.0};
  EXPECT_EQ(fingerprint(make_tube(shape, 2000).value()), fingerprint(make_tube(shape, 2000).value()));
}

TEST(Tube, ErrorNamesCountsThatCanBeHad) {
  for (const auto& [shape, nodes] : {TubeCase{{}, 3}, TubeCase{{.wall = 0.0002}, 100}, TubeCase{{.length = 10.0}, 100},
                                     TubeCase{{}, std::numeric_limits<int>::max()}}) {
    SCOPED_TRACE(nodes);
    expect_error_offers_counts([&](int count) { return make_tube(shape, count); }, nodes);
  }
}

TEST(Tube, RefusesShapesThatCannotBe) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const TubeShape& shape :
       {TubeShape{.radius = 0.0}, TubeShape{.radius = nan}, TubeShape{.length = -1.0}, TubeShape{.wall = 0.005},
        TubeShape{.wall = -0.001}, TubeShape{.wall = nan}, TubeShape{.bend = nan}, TubeShape{.bend = 360.0}})
    EXPECT_FALSE(make_tube(shape, 1000).has_value());
  // 0.04 m around 0.005 m: the inner side would shrink to nothing at 458 degrees; a shorter one earlier.
  const auto sharp = make_tube({.radius = 0.005, .length = 0.01, .bend = 120.0}, 1000);
  ASSERT_FALSE(sharp.has_value());
  EXPECT_THAT(sharp.error().remedy, testing::HasSubstr("114.6"));
}

}  // namespace
}  // namespace rhexis::mesh
