#include <gtest/gtest.h>

#include <limits>

#include "tests/mesh/generate_support.h"

namespace rhexis::mesh {
namespace {

const Vec3 kThesisPlate(0.24, 0.24, 0.01);

struct PlateCase {
  Vec3 size;
  int nodes;
  double min_dihedral;
  double mean_radius_ratio;
};

class Plate : public testing::TestWithParam<PlateCase> {};

TEST_P(Plate, IsABoxOfAboutSoManyNodesAndWellShaped) {
  const auto& [size, nodes, min_dihedral, mean_radius_ratio] = GetParam();
  const auto mesh = make_plate({size}, nodes);
  ASSERT_TRUE(mesh.has_value()) << mesh.error().message();
  EXPECT_NEAR(static_cast<double>(mesh->node_count()), nodes, 0.02 * nodes);
  expect_box(*mesh, size);
  expect_no_preferred_diagonal(*mesh);
  const Quality quality = measure_quality(*mesh);
  EXPECT_GT(quality.dihedral.min, min_dihedral);
  EXPECT_GT(quality.radius_ratio.mean, mean_radius_ratio);
}

INSTANTIATE_TEST_SUITE_P(Shapes, Plate,
                         testing::Values(PlateCase{kThesisPlate, 506, 20, 0.7}, PlateCase{kThesisPlate, 765, 20, 0.7},
                                         PlateCase{kThesisPlate, 1012, 20, 0.7}, PlateCase{kThesisPlate, 1270, 20, 0.7},
                                         PlateCase{kThesisPlate, 5000, 18, 0.7},
                                         PlateCase{kThesisPlate, 20000, 18, 0.7},
                                         // Too few nodes for a thin body: tets as flat as they must be, but sound.
                                         PlateCase{kThesisPlate, 50, 5, 0.3}, PlateCase{kThesisPlate, 100, 8, 0.4},
                                         PlateCase{{1, 0.1, 0.01}, 3000, 18, 0.7},
                                         PlateCase{{1, 2, 3}, 2000, 18, 0.7}));

TEST(Plate, ThesisPlatesHaveTheCountsOfTheThesis) {
  // Nodes and tets of the plates in the thesis; its meshes are unstructured with one layer, like ours.
  for (const auto& [nodes, tets] : {std::pair{506, 1266}, {765, 2017}, {1012, 2718}, {1270, 3487}}) {
    const TetMesh mesh = make_plate({kThesisPlate}, nodes).value();
    EXPECT_NEAR(static_cast<double>(mesh.node_count()), nodes, 1.0);
    EXPECT_NEAR(static_cast<double>(mesh.tet_count()), tets, 0.07 * tets);
    for (const Vec3& x : mesh.nodes) EXPECT_TRUE(x[2] == 0.0 || x[2] == 0.01) << "one layer";
  }
}

TEST(Plate, EveryCountFromFiftyOnCanBeHad) {
  for (int nodes = 50; nodes < 1300; nodes += nodes < 200 ? 1 : 7) {
    const auto mesh = make_plate({kThesisPlate}, nodes);
    ASSERT_TRUE(mesh.has_value()) << mesh.error().message();
    ASSERT_NEAR(static_cast<double>(mesh->node_count()), nodes, 0.02 * nodes);
    ASSERT_NEAR(total_volume(*mesh), kThesisPlate.prod(), 1e-12 * kThesisPlate.prod()) << nodes;
    ASSERT_TRUE(find_defects(*mesh).empty()) << nodes;
  }
}

TEST(Plate, ShapeHoldsForEveryCount) {
  for (int nodes = 500; nodes < 1500; nodes += 13) {
    const Quality quality = measure_quality(make_plate({kThesisPlate}, nodes).value());
    EXPECT_GT(quality.dihedral.min, 17.0) << nodes;
    EXPECT_GT(quality.radius_ratio.mean, 0.7) << nodes;
  }
}

TEST(Plate, IsTheSameEveryTime) {
  EXPECT_EQ(fingerprint(make_plate({kThesisPlate}, 1012).value()),
            fingerprint(make_plate({kThesisPlate}, 1012).value()));
}

TEST(Plate, KeepsItsFormAtAnyScale) {
  const Quality metres = measure_quality(make_plate({kThesisPlate}, 506).value());
  for (const double scale : {1e-9, 1e9}) {
    const Quality scaled = measure_quality(make_plate({scale * kThesisPlate}, 506).value());
    EXPECT_NEAR(scaled.dihedral.min, metres.dihedral.min, 1e-6);
  }
}

TEST(Plate, ErrorNamesCountsThatCanBeHad) {
  for (const auto& [size, nodes] : {std::pair<Vec3, int>{kThesisPlate, 3},
                                    {Vec3(1, 1, 0.001), 506},
                                    {Vec3(1, 0.1, 0.01), 51},
                                    {kThesisPlate, std::numeric_limits<int>::max()}}) {
    SCOPED_TRACE(nodes);
    expect_error_offers_counts([&](int count) { return make_plate({size}, count); }, nodes);
  }
}

TEST(Plate, RefusesSidesThatAreNoLengths) {
  for (const double bad : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(), 1e300})
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 size = kThesisPlate;
      size[axis] = bad;
      EXPECT_FALSE(make_plate({size}, 506).has_value());
    }
  EXPECT_FALSE(make_plate({Vec3(1e-30, 1e30, 1)}, 506).has_value());
  EXPECT_FALSE(make_plate({Vec3(1, 1, 1e-30)}, 506).has_value());
}

}  // namespace
}  // namespace rhexis::mesh
