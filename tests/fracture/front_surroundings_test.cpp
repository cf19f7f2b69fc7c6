#include "fracture/front_surroundings.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "mesh/quality.h"
#include "mesh/surface.h"
#include "tests/fracture/cracked_plate.h"
#include "tests/fracture/cut_support.h"
#include "tests/fracture/stress_fields.h"

namespace rhexis::fracture::test {
namespace {

TEST(Surroundings, KnowsAPlate) {
  EXPECT_TRUE(Surroundings(*mesh::make_plate({Vec3(0.24, 0.24, 0.01)}, 506)).is_plate());
  EXPECT_TRUE(Surroundings(cracked_plate(Vec3(0.24, 0.24, 0.01), {12, 12, 1}, 3, 0.2)).is_plate());
  EXPECT_FALSE(Surroundings(*mesh::make_bar({Vec3(0.1, 0.1, 0.4)}, 400)).is_plate());
  EXPECT_FALSE(
      Surroundings(*mesh::make_tube({.radius = 0.005, .length = 0.02, .wall = 0.001, .bend = 0.0}, 700)).is_plate());
  EXPECT_FALSE(Surroundings(mesh::make_structured_box(Vec3(0.01, 0.24, 0.24), {1, 12, 12})).is_plate());
}

TEST(Surroundings, FindsTheTetsNearAFrontAsASearchThroughAllDoes) {
  CutBody cut(*mesh::make_bar({Vec3(0.1, 0.1, 0.3)}, 1500));
  Crack crack;
  for (const Vec3& at : {Vec3(-0.01, 0.04, 0.1), Vec3(0.05, 0.05, 0.14), Vec3(0.11, 0.06, 0.12)})
    crack.front.push_back({at, Vec3::UnitY(), Vec3::UnitX()});
  // Moved nodes, as incisions leave them.
  mesh::MeshEdit edit;
  std::mt19937_64 random(3);
  for (std::size_t node = 0; node < cut.body.mesh().node_count(); node += 3) {
    const Vec3& at = cut.body.mesh().nodes[node];
    const Vec3 by = 0.004 * Vec3(uniform(random) - 0.5, uniform(random) - 0.5, uniform(random) - 0.5);
    edit.moved.push_back({NodeId(node), at, at + by});
  }
  edit.removed = {TetId(5), TetId(77)};
  cut.apply(edit);
  for (const double radius : {0.0, 0.02, 0.05, 1.0}) {
    std::vector<TetId> slow;
    for (std::size_t tet = 0; tet < cut.body.mesh().tet_count(); ++tet) {
      if (!cut.body.is_solved(TetId(tet))) continue;
      Vec3 centroid = Vec3::Zero();
      for (const NodeId node : cut.body.mesh().tets[tet]) centroid += 0.25 * cut.body.mesh().node(node);
      double nearest = 1e9;
      for (int i = 0; i < 2; ++i) {
        const Vec3 a = crack.front[static_cast<std::size_t>(i)].position;
        const Vec3 way = crack.front[static_cast<std::size_t>(i) + 1].position - a;
        const double part = std::clamp((centroid - a).dot(way) / way.squaredNorm(), 0.0, 1.0);
        nearest = std::min(nearest, (centroid - a - part * way).norm());
      }
      if (nearest <= radius) slow.emplace_back(tet);
    }
    EXPECT_EQ(cut.surroundings.tets_near(cut.body, crack, radius), slow);
  }
}

TEST(Surroundings, SaysWhereALineIsInside) {
  const Surroundings bar(*mesh::make_bar({Vec3(0.1, 0.1, 0.3)}, 800));
  const auto through = bar.inside(Vec3(-0.1, 0.03, 0.1), Vec3(0.3, 0.04, 0.2));
  ASSERT_EQ(through.size(), 1u);
  EXPECT_NEAR(through[0].from, 0.25, 1e-6);  // the closed body, to the tolerance of a gap: 1e-7 of an edge
  EXPECT_NEAR(through[0].to, 0.5, 1e-6);
  EXPECT_TRUE(bar.inside(Vec3(-0.1, 0.2, 0.1), Vec3(0.3, 0.2, 0.2)).empty());
  EXPECT_TRUE(bar.is_inside(Vec3(0.05, 0.05, 0.15)));
  EXPECT_FALSE(bar.is_inside(Vec3(0.05, 0.05, 0.31)));
  // Along an edge of the body, which belongs to it.
  const auto edge = bar.inside(Vec3(0.0, 0.0, -0.1), Vec3(0.0, 0.0, 0.9));
  ASSERT_EQ(edge.size(), 1u);
  EXPECT_NEAR(edge[0].from, 0.1, 1e-6);
  EXPECT_NEAR(edge[0].to, 0.4, 1e-6);
}

// A crack point may be given anywhere: the time goes with the body, and so does what is found of it.
TEST(Surroundings, SaysWhereALineFromFarAwayIsInside) {
  const Surroundings bar(*mesh::make_bar({Vec3(0.1, 0.1, 0.3)}, 800));
  for (const double far : {1e6, 1e12}) {
    const auto through = bar.inside(Vec3(-far, 0.03, 0.1), Vec3(far, 0.04, 0.2));
    ASSERT_EQ(through.size(), 1u) << far;
    // The way is known to the rounding of its ends, and a gap's 1e-7 of an edge.
    const double rounding = 1e-8 + 4e-16 * far;
    EXPECT_NEAR(2.0 * far * (through[0].to - through[0].from), 0.1, 4.0 * rounding) << far;
    EXPECT_NEAR(-far + 2.0 * far * through[0].from, 0.0, 4.0 * rounding) << far;
    EXPECT_TRUE(bar.inside(Vec3(0.05, 0.05, 0.4), Vec3(0.05, 0.05, far)).empty()) << far;
    EXPECT_TRUE(bar.inside(Vec3(-far, -far, far), Vec3(far, -far, -far)).empty()) << far;
    EXPECT_FALSE(bar.is_inside(Vec3(far, 0.05, 0.15))) << far;
  }
}

TEST(Surroundings, SeesTheHoleOfATube) {
  const Surroundings tube(*mesh::make_tube({.radius = 0.005, .length = 0.04, .wall = 0.001, .bend = 0.0}, 1500));
  const auto parts = tube.inside(Vec3(-0.01, 0.0003, 0.02), Vec3(0.01, 0.0003, 0.02));
  ASSERT_EQ(parts.size(), 2u);
  // Facets lie a little inside of the circles of 5 and 4 mm.
  EXPECT_NEAR(parts[0].from, 0.25, 0.02);
  EXPECT_NEAR(parts[0].to, 0.3, 0.02);
  EXPECT_NEAR(parts[1].from, 0.7, 0.02);
  EXPECT_NEAR(parts[1].to, 0.75, 0.02);
}

TEST(Surroundings, StillCountsWhatWasTakenOut) {
  CutBody cut(*mesh::make_bar({Vec3(0.1, 0.1, 0.3)}, 800));
  mesh::MeshEdit edit;
  for (int tet = 0; tet < 500; ++tet) edit.removed.emplace_back(tet);
  cut.apply(edit);
  EXPECT_EQ(cut.surroundings.inside(Vec3(0.05, 0.05, -1.0), Vec3(0.05, 0.05, 1.0)).size(), 1u);
}

TEST(Surroundings, FindsTheNearestPointOfTheSurface) {
  const mesh::TetMesh mesh = *mesh::make_tube({.radius = 0.005, .length = 0.02, .wall = 0.0015, .bend = 40.0}, 700);
  const Surroundings tube(mesh);
  std::mt19937_64 random(4);
  const mesh::BoundingBox box = tube.box();
  const auto boundary = mesh::find_faces(mesh).boundary;
  for (int trial = 0; trial < 50; ++trial) {
    Vec3 at;
    for (int k = 0; k < 3; ++k) at[k] = box.from[k] + (1.4 * uniform(random) - 0.2) * box.size()[k];
    double slow = 1e9;  // by many points of every triangle
    for (const mesh::TetFace& face : boundary) {
      const auto nodes = mesh::face_nodes(mesh, face);
      for (int i = 0; i <= 20; ++i)
        for (int j = 0; i + j <= 20; ++j)
          slow = std::min(slow, (mesh.node(nodes[0]) * (i / 20.0) + mesh.node(nodes[1]) * (j / 20.0) +
                                 mesh.node(nodes[2]) * ((20 - i - j) / 20.0) - at)
                                    .norm());
    }
    const double fast = (tube.nearest_on_surface(at) - at).norm();
    EXPECT_LE(fast, slow * (1.0 + 1e-12));
    EXPECT_GT(fast, slow - 0.05 * tube.mean_edge());  // the points lie a twentieth of an edge apart
  }
}

}  // namespace
}  // namespace rhexis::fracture::test
