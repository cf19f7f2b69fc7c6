// The incision that keeps the nodes, on grids of cubes with six tets each, where every number can be told by hand.

#include "fracture/keep_nodes.h"

#include <gtest/gtest.h>

#include "tests/fracture/cut_support.h"
#include "tests/support/kuhn_box.h"

namespace rhexis::fracture::test {
namespace {

using rhexis::test::KuhnGrid;
using rhexis::test::make_kuhn_box;

/// Cells of side 1, nodes at whole numbers.
mesh::TetMesh cubes(const std::array<int, 3>& cells) {
  KuhnGrid grid;
  grid.cells = cells;
  grid.jitter = Vec3::Zero();
  return make_kuhn_box(grid);
}

// Every tet of the layer 2 < x < 3 has an edge through x = 2.4, and no other tet has. Both flanks come to lie on the
// plane, so that nothing is lost of the volume: the layer's volume is taken over by its neighbours.
TEST(KeepNodes, ACutRightThroughTakesALayerOfTets) {
  CutBody cut(cubes({6, 3, 2}));
  const Incision incision = cut.incise(across_x(2.4, -0.5, 3.5, -0.5, 2.5));
  ASSERT_EQ(incision.edit.removed.size(), 6U * 3U * 2U);
  for (const TetId tet : incision.edit.removed)
    for (const Vec3& x : mesh::corners(cut.body.mesh(), tet)) EXPECT_TRUE(x[0] == 2.0 || x[0] == 3.0);
  EXPECT_EQ(incision.edit.moved.size(), 2U * 4U * 3U);
  for (const mesh::MovedNode& move : incision.edit.moved) {
    EXPECT_NEAR(move.to[0], 2.4, 1e-15);
    EXPECT_EQ(move.to.tail<2>(), move.from.tail<2>());
  }
  EXPECT_EQ(incision.nodes_off_plane, 0);
  EXPECT_TRUE(incision.edit.copied.empty());
  EXPECT_TRUE(incision.edit.rewired.empty());
  EXPECT_TRUE(incision.edit.frozen.empty());
  // Sums of some hundred volumes of up to 1/3.
  EXPECT_NEAR(incision.volume_lost, 0.0, 1e-13);
  const double before = cut.body.volume();
  cut.apply(incision.edit);
  EXPECT_NEAR(cut.body.volume(), before, 1e-13 * before);
  expect_round(cut);
  expect_manifold_faces(cut.body);
}

// Edges of a layer: per cell face between the layers' nodes one edge along x, diagonals of the cell's sides, and one
// diagonal of the cell.
TEST(KeepNodes, EveryCrossedEdgeIsCounted) {
  const CutBody cut(cubes({6, 3, 2}));
  const int along = 4 * 3;
  const int in_sides = 3 * 3 + 4 * 2;  // one diagonal in each side of a cell that is not in a plane of the layer
  const int through = 3 * 2;
  EXPECT_EQ(cut.incise(across_x(2.4, -0.5, 3.5, -0.5, 2.5)).edges_cut, along + in_sides + through);
}

// A node in the plane is above it: the layer below goes, its lower nodes come up.
TEST(KeepNodes, APlaneThroughNodesTakesTheLayerBelow) {
  CutBody cut(cubes({6, 3, 2}));
  for (const double slip : {0.0, 1e-10, -1e-10}) {  // times the mean edge of 1.3, within kOnPlane
    const Incision incision = cut.incise(across_x(3.0 + slip, -0.5, 3.5, -0.5, 2.5));
    EXPECT_EQ(incision.edit.removed.size(), 6U * 3U * 2U);
    EXPECT_EQ(incision.edit.moved.size(), 4U * 3U);
    for (const mesh::MovedNode& move : incision.edit.moved) {
      EXPECT_EQ(move.from[0], 2.0);
      EXPECT_NEAR(move.to[0], 3.0, 2e-10);
    }
    EXPECT_EQ(incision.nodes_off_plane, 0);
    EXPECT_NEAR(incision.volume_lost, 0.0, slip == 0.0 ? 1e-13 : 1e-8);
  }
}

TEST(KeepNodes, BeyondTheFrontAllStays) {
  CutBody cut(cubes({6, 6, 2}));
  const Incision incision = cut.cut(across_x(2.4, -0.5, 2.5, -0.5, 2.5));
  ASSERT_FALSE(incision.edit.removed.empty());
  for (const TetId tet : incision.edit.removed) {
    double lowest = 6.0;
    for (const Vec3& x : mesh::corners(cut.body.mesh(), tet)) lowest = std::min(lowest, x[1]);
    EXPECT_LE(lowest, 2.0);
  }
  for (const mesh::MovedNode& move : incision.edit.moved) EXPECT_LE(move.from[1], 3.0);
  expect_round(cut);
  expect_manifold_faces(cut.body);
  EXPECT_EQ(find_pieces(cut.body, cut.held).count(), 1U);
  // All get to the plane here; ahead of the front the gap closes to a wedge, whose volume is gone.
  EXPECT_EQ(incision.nodes_off_plane, 0);
  EXPECT_GT(incision.volume_lost, 0.0);
}

TEST(KeepNodes, WhatMeetsNoEdgeIsEmpty) {
  const CutBody cut(cubes({6, 3, 2}));
  for (const CutSurface& surface :
       {across_x(2.4, 3.2, 4.0, -0.5, 2.5), across_x(7.0, -0.5, 3.5, -0.5, 2.5), across_x(2.4, 0.1, 0.15, 0.02, 0.05),
        CutSurface{}, strip({{2.4, 0, 0}, {2.4, 0, 0}}, {{2.4, 1, 0}, {2.4, 1, 0}}),
        strip({{std::nan(""), 0, 0}, {2.4, 0, 2}}, {{2.4, 1, 0}, {2.4, 1, 2}})}) {
    const Incision incision = cut.incise(surface);
    EXPECT_TRUE(incision.edit.empty());
    EXPECT_EQ(incision.edges_cut, 0);
    EXPECT_EQ(incision.volume_lost, 0.0);
  }
}

TEST(KeepNodes, SupportedNodesStayAndAreCounted) {
  CutBody cut(cubes({6, 3, 2}));
  cut.hold([](const Vec3& x) { return x[0] <= 2.0; });
  const Incision incision = cut.cut(across_x(2.4, -0.5, 3.5, -0.5, 2.5));
  EXPECT_EQ(incision.edit.removed.size(), 6U * 3U * 2U);
  EXPECT_EQ(incision.nodes_off_plane, 4 * 3);
  EXPECT_EQ(incision.edit.moved.size(), 4U * 3U);
  EXPECT_NEAR(incision.volume_lost, 0.4 * 3 * 2, 1e-13);
}

// Two triangles make the strip: edges through the diagonal between them must not slip through. The diagonal runs
// through edges of the grid, in directions that do not round well.
TEST(KeepNodes, NothingSlipsThroughBetweenTriangles) {
  KuhnGrid grid;
  grid.cells = {4, 4, 4};
  grid.jitter = Vec3::Zero();
  const Eigen::AngleAxisd turn(0.7, Vec3(1, 2, 3).normalized());
  grid.map = [&](const Vec3& x) { return Vec3(turn * (x / 3.0)); };
  const CutBody cut(make_kuhn_box(grid));
  for (const double x : {1.5, 1.0 / 3.0, 2.7}) {
    CutSurface surface = across_x(x, -1.0, 5.0, -1.0, 5.0);  // its diagonal is y + z = 4: through the nodes' lines
    for (CutSurface::Triangle& t : surface.triangles)
      for (Vec3* corner : {&t.a, &t.b, &t.c}) *corner = turn * Vec3(*corner / 3.0);
    EXPECT_EQ(cut.incise(surface).edit.removed.size(), 6U * 16U) << x;
  }
}

// A tet all four corners of which are called to the plane would be flat: one of them has to stay off.
TEST(KeepNodes, ATetIsNotFlattened) {
  mesh::TetMesh one;
  one.nodes = {{0, 0, 0.1}, {1, 0, 0.2}, {0, 1, 0.15}, {0.3, 0.3, 0.9}};
  one.tets = {{NodeId(0), NodeId(1), NodeId(2), NodeId(3)}};
  for (int below = 0; below < 4; ++below) {  // one tet hangs below each corner of the first
    const auto corner = static_cast<std::size_t>(below);
    const Vec3 x = one.nodes[corner];
    const auto first = one.nodes.size();
    for (const Vec3& at : {Vec3(0.1, 0, -0.4), Vec3(0, 0.1, -0.4), Vec3(0, 0, -0.5)})
      one.nodes.emplace_back(x[0] + at[0], x[1] + at[1], at[2]);
    one.tets.push_back({NodeId(corner), NodeId(first), NodeId(first + 2), NodeId(first + 1)});
    if (mesh::signed_volume(one, TetId(one.tet_count() - 1)) < 0.0) std::swap(one.tets.back()[1], one.tets.back()[2]);
  }
  CutBody cut(one);
  const Incision incision = cut.cut(strip({{-2, -2, 0}, {2, -2, 0}}, {{-2, 2, 0}, {2, 2, 0}}));
  EXPECT_EQ(incision.edit.removed.size(), 4U);
  EXPECT_EQ(incision.nodes_off_plane, 1);
  EXPECT_TRUE(cut.body.is_alive(TetId(std::size_t{0})));
  expect_round(cut);
  int on_plane = 0;  // the nearest three go first
  for (std::size_t node = 0; node < 3; ++node) on_plane += std::abs(cut.body.mesh().nodes[node][2]) < 1e-15 ? 1 : 0;
  EXPECT_EQ(on_plane, 3);
  EXPECT_LT(cut.body.mesh().nodes[3][2], 0.9);  // but it has come nearer
}

}  // namespace
}  // namespace rhexis::fracture::test
