#include <gtest/gtest.h>

#include <limits>

#include "tests/mesh/generate_support.h"

namespace rhexis::mesh {
namespace {

/// The usual cut of each cell into six tets around the diagonal (0,0,0)-(1,1,1): the worst case of a preferred
/// diagonal.
TetMesh kuhn_box(int n) {
  TetMesh mesh = make_structured_box({1, 1, 1}, {n, n, n});
  mesh.tets.clear();
  const auto node = [&](const std::array<int, 3>& i) { return NodeId((i[2] * (n + 1) + i[1]) * (n + 1) + i[0]); };
  for (int c = 0; c < n * n * n; ++c) {
    std::array<int, 3> axes{0, 1, 2};
    do {
      std::array<int, 3> at{c % n, c / n % n, c / n / n};
      Tet tet{node(at)};
      for (std::size_t step = 0; step < 3; ++step) {
        ++at[static_cast<std::size_t>(axes[step])];
        tet[step + 1] = node(at);
      }
      mesh.tets.push_back(tet);
    } while (std::next_permutation(axes.begin(), axes.end()));
  }
  orient_tets(mesh);
  return mesh;
}

TEST(PreferredDiagonal, IsSeenWhereThereIsOne) {
  const TetMesh mesh = kuhn_box(4);
  EXPECT_NEAR(total_volume(mesh), 1.0, 1e-14);
  EXPECT_GT(diagonal_bias(mesh).minCoeff(), 8.0);
}

TEST(StructuredBox, HasFiveTetsACell) {
  const TetMesh mesh = make_structured_box({1, 2, 3}, {3, 4, 5});
  EXPECT_EQ(mesh.node_count(), 4u * 5u * 6u);
  EXPECT_EQ(mesh.tet_count(), 5u * 3u * 4u * 5u);
  expect_box(mesh, {1, 2, 3});
}

TEST(StructuredBox, FitsItsBoxExactly) {
  // Among these are sides where n * (side / n) or (n * side) / n is not the side.
  for (int n = 1; n <= 12; ++n) expect_box(make_structured_box({0.1, 0.3, 0.7}, {n, 1, n}), {0.1, 0.3, 0.7});
}

TEST(StructuredBox, HalvesExactly) {
  const TetMesh coarse = make_structured_box({0.1, 0.3, 0.7}, {3, 5, 7});
  const TetMesh fine = make_structured_box({0.1, 0.3, 0.7}, {6, 10, 14});
  for (int k = 0; k <= 7; ++k)
    for (int j = 0; j <= 5; ++j)
      for (int i = 0; i <= 3; ++i) {
        const auto at = [&](int f) {
          return static_cast<std::size_t>(((f * k) * (f * 5 + 1) + f * j) * (f * 3 + 1) + f * i);
        };
        EXPECT_EQ(coarse.nodes[at(1)], fine.nodes[at(2)]) << i << " " << j << " " << k;
      }
  // Edges are differences of coordinates that were rounded at the size of the box: up to 14 times the edge.
  EXPECT_NEAR(measure_quality(coarse).edge.max / measure_quality(fine).edge.max, 2.0, 1e-14);
  EXPECT_NEAR(measure_quality(coarse).edge.min / measure_quality(fine).edge.min, 2.0, 1e-14);
}

TEST(StructuredBox, HasNoPreferredDiagonal) {
  expect_no_preferred_diagonal(make_structured_box({1, 1, 1}, {4, 4, 4}));
  expect_no_preferred_diagonal(make_structured_box({1, 1, 2}, {5, 6, 7}));
}

struct BarCase {
  Vec3 size;
  int nodes;
};

class Bar : public testing::TestWithParam<BarCase> {};

TEST_P(Bar, IsABoxOfSoManyNodesAndWellShaped) {
  const auto& [size, nodes] = GetParam();
  const auto mesh = make_bar({size}, nodes);
  ASSERT_TRUE(mesh.has_value()) << mesh.error().message();
  EXPECT_EQ(mesh->node_count(), static_cast<std::size_t>(nodes));
  expect_box(*mesh, size);
  expect_no_preferred_diagonal(*mesh);
  const Quality quality = measure_quality(*mesh);
  EXPECT_GT(quality.dihedral.min, 20.0);
  EXPECT_GT(quality.radius_ratio.mean, 0.7);
}

INSTANTIATE_TEST_SUITE_P(Shapes, Bar,
                         testing::Values(BarCase{{0.1, 0.1, 0.4}, 425}, BarCase{{0.1, 0.1, 0.4}, 3000},
                                         BarCase{{1, 1, 1}, 50}, BarCase{{1, 1, 1}, 1000}, BarCase{{1, 1, 1}, 20000},
                                         BarCase{{1, 2, 3}, 777}, BarCase{{3, 0.3, 1}, 5000}));

TEST(Bar, OfLargeCubesIsVeryRegular) {
  const Quality quality = measure_quality(make_bar({Vec3(1, 1, 1)}, 30000).value());
  EXPECT_GT(quality.dihedral.min, 44.0);
  EXPECT_GT(quality.radius_ratio.mean, 0.92);
}

TEST(Bar, EveryCountFromFiftyOnCanBeHad) {
  for (const Vec3& size : {Vec3(1, 1, 1), Vec3(0.1, 0.1, 0.4), Vec3(1, 1.3, 1.7)})
    for (int nodes = 50; nodes < 300; ++nodes) {
      const auto mesh = make_bar({size}, nodes);
      ASSERT_TRUE(mesh.has_value()) << mesh.error().message();
      ASSERT_EQ(mesh->node_count(), static_cast<std::size_t>(nodes));
    }
}

TEST(Bar, IsTheSameEveryTime) {
  EXPECT_EQ(fingerprint(make_bar({Vec3(1, 1, 2)}, 3000).value()), fingerprint(make_bar({Vec3(1, 1, 2)}, 3000).value()));
}

TEST(Bar, ErrorNamesCountsThatCanBeHad) {
  for (const auto& [size, nodes] : {BarCase{{1, 1, 1}, 3}, BarCase{{1, 1, 1}, -5}, BarCase{{1, 1, 0.01}, 100},
                                    BarCase{{1, 1, 1}, std::numeric_limits<int>::max()}}) {
    SCOPED_TRACE(nodes);
    expect_error_offers_counts([&](int count) { return make_bar({size}, count); }, nodes);
  }
}

TEST(Bar, RefusesSidesThatAreNoLengths) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  for (const double bad : {0.0, -1.0, nan, inf, 1e-300, 1e300})
    EXPECT_FALSE(make_bar({Vec3(1, bad, 1)}, 1000).has_value()) << bad;
  // Sides of any proportion are answered, if only by an error, and quickly.
  EXPECT_FALSE(make_bar({Vec3(1e-30, 1, 1e30)}, 1000).has_value());
  EXPECT_FALSE(make_bar({Vec3(1, 1, 1e7)}, 1000).has_value());
}

}  // namespace
}  // namespace rhexis::mesh
