// The incision that keeps the volume, on grids of cubes with six tets each.

#include "fracture/split.h"

#include <gtest/gtest.h>

#include "mesh/generate.h"
#include "mesh/surface.h"
#include "tests/fracture/cut_support.h"
#include "tests/support/kuhn_box.h"

namespace rhexis::fracture::test {
namespace {

/// Cells of side 1, nodes at whole numbers.
mesh::TetMesh cubes(const std::array<int, 3>& cells) {
  rhexis::test::KuhnGrid grid;
  grid.cells = cells;
  grid.jitter = Vec3::Zero();
  return rhexis::test::make_kuhn_box(grid);
}

// 4 x 3 nodes lie in the plane: each is doubled, no tet goes, nothing moves.
TEST(Split, APlaneOfNodesIsDoubled) {
  CutBody cut(cubes({6, 3, 2}), IncisionMethod::split);
  const Incision incision = cut.incise(across_x(3.0, -0.5, 3.5, -0.5, 2.5));
  EXPECT_TRUE(incision.edit.moved.empty());
  EXPECT_TRUE(incision.edit.removed.empty());
  ASSERT_EQ(incision.edit.copied.size(), 4U * 3U);
  EXPECT_TRUE(std::is_sorted(incision.edit.copied.begin(), incision.edit.copied.end()));
  for (const NodeId node : incision.edit.copied) EXPECT_EQ(cut.body.mesh().node(node)[0], 3.0);
  EXPECT_EQ(incision.volume_lost, 0.0);
  EXPECT_EQ(incision.nodes_off_plane, 0);
  cut.apply(incision.edit);
  for (std::size_t copy = cut.body.intact_node_count(); copy < cut.body.mesh().node_count(); ++copy) {
    EXPECT_EQ(cut.body.original(NodeId(copy)), incision.edit.copied[copy - cut.body.intact_node_count()]);
    EXPECT_TRUE(cut.body.is_alive(NodeId(copy)));
  }
  // Numbers go up along x, so the lowest tet around a node is below the plane, and the copies are above.
  for (const mesh::RewiredTet& change : incision.edit.rewired)
    for (const Vec3& x : mesh::corners(cut.body.mesh(), change.tet)) EXPECT_GE(x[0], 3.0);
  EXPECT_EQ(find_pieces(cut.body, cut.held).count(), 2U);
  expect_manifold_faces(cut.body);
}

// The front stands at y = 1: the nodes there stay whole. Sides of 2 x 2 squares with two triangles each are opened, and
// the surface of the body grows by both their sides.
TEST(Split, TheFrontStaysWhole) {
  CutBody cut(cubes({6, 3, 2}), IncisionMethod::split);
  const std::size_t before = mesh::find_faces(cut.body.mesh()).boundary.size();
  const Incision incision = cut.cut(across_x(3.0, -0.5, 2.0, -0.5, 2.5));
  EXPECT_EQ(incision.edit.copied.size(), 2U * 3U);
  for (const NodeId node : incision.edit.copied) EXPECT_LT(cut.body.mesh().node(node)[1], 2.0);
  EXPECT_EQ(mesh::find_faces(cut.body.mesh()).boundary.size(), before + 2U * (2U * 2U * 2U));
  EXPECT_EQ(find_pieces(cut.body, cut.held).count(), 1U);
  expect_manifold_faces(cut.body);

  // Run on from there to between nodes: what hung together at the front comes apart.
  EXPECT_TRUE(cut.incise(across_x(3.0, 2.0, 2.9, -0.5, 2.5)).edit.empty());
  cut.cut(across_x(3.0, 2.0, 3.2, -0.5, 2.5));
  EXPECT_EQ(find_pieces(cut.body, cut.held).count(), 2U);
  EXPECT_EQ(mesh::find_faces(cut.body.mesh()).boundary.size(), before + 2U * (3U * 2U * 2U));
}

// Nodes at x = 2 are nearer than those at x = 3; along the sides and inside the body a move keeps the volume.
TEST(Split, TheNearerNodesAreSnapped) {
  CutBody cut(cubes({6, 3, 2}), IncisionMethod::split);
  const Incision incision = cut.cut(across_x(2.3, -0.5, 3.5, -0.5, 2.5));
  ASSERT_EQ(incision.edit.moved.size(), 4U * 3U);
  for (const mesh::MovedNode& move : incision.edit.moved) {
    EXPECT_EQ(move.from[0], 2.0);
    EXPECT_NEAR(move.to[0], 2.3, 1e-15);
    EXPECT_EQ(move.to.tail<2>(), move.from.tail<2>());
  }
  EXPECT_EQ(incision.edit.copied.size(), 4U * 3U);
  EXPECT_NEAR(incision.volume_lost, 0.0, 1e-13);  // sums of some hundred volumes
  EXPECT_NEAR(cut.body.volume(), 36.0, 1e-12);
  EXPECT_EQ(find_pieces(cut.body, cut.held).count(), 2U);
  expect_round(cut);
}

// What may not move is gone round: the other end is snapped, or the faces beside it are opened.
TEST(Split, SupportedNodesStayAndTheBodyIsCutAllTheSame) {
  for (const double reach : {2.0, 3.0}) {
    CutBody cut(cubes({6, 3, 2}), IncisionMethod::split);
    cut.hold([&](const Vec3& x) { return x[0] >= 2.0 && x[0] <= reach; });
    const Incision incision = cut.cut(across_x(2.3, -0.5, 3.5, -0.5, 2.5));
    EXPECT_EQ(incision.edit.moved.size(), reach == 2.0 ? 12U : 0U);
    EXPECT_EQ(incision.nodes_off_plane, reach == 2.0 ? 0 : 24);
    for (const mesh::MovedNode& move : incision.edit.moved) EXPECT_EQ(move.from[0], 3.0);
    EXPECT_EQ(find_pieces(cut.body, cut.held).count(), 2U);
    EXPECT_NEAR(cut.body.volume(), 36.0, 1e-12);
    expect_round(cut);
    expect_manifold_faces(cut.body);
  }
}

// The hand may hold one flank: that stays, and the other is as free as before.
TEST(Split, AHeldCopyStaysAndItsOriginalMayMove) {
  CutBody cut(cubes({6, 3, 2}), IncisionMethod::split);
  cut.cut(across_x(3.0, -0.5, 3.5, -0.5, 2.5));
  for (std::size_t copy = cut.body.intact_node_count(); copy < cut.body.mesh().node_count(); ++copy)
    cut.settings.immovable[copy] = cut.body.mesh().nodes[copy][1] == 1.0;
  const Incision incision =
      cut.incise(strip({{-0.5, 1.3, -0.5}, {-0.5, 1.3, 2.5}}, {{6.5, 1.3, -0.5}, {6.5, 1.3, 2.5}}));
  int originals = 0;
  int copies = 0;  // the further ends of the edges that the held ones have
  for (const mesh::MovedNode& move : incision.edit.moved) {
    ASSERT_EQ(cut.settings.immovable[move.node.index()], 0);
    if (move.from[0] != 3.0) continue;
    const bool is_copy = move.node.index() >= cut.body.intact_node_count();
    EXPECT_EQ(move.from[1], is_copy ? 2.0 : 1.0);
    ++(is_copy ? copies : originals);
  }
  EXPECT_EQ(originals, 3);
  EXPECT_EQ(copies, 3);
}

// Nothing is cut twice: not along its own gap, nor by a crack that comes from elsewhere and runs along it.
TEST(Split, WhatOpensNothingIsEmpty) {
  CutBody cut(cubes({6, 4, 2}), IncisionMethod::split);
  // One edge is met, no face of it comes free of the front: nothing has moved either.
  const CutSurface corner = across_x(2.3, -0.5, 0.6, -0.5, 0.4);
  EXPECT_TRUE(cut.incise(corner).edit.empty());
  EXPECT_EQ(cut.incise(corner).edges_cut, 0);

  cut.cut(across_x(3.0, -0.5, 4.5, -0.5, 2.5));
  const std::uint64_t before = fingerprint(cut.body);
  const CutSurface along = strip({{3.0, 1.0, -0.5}, {3.0, 4.5, -0.5}}, {{3.0, 1.0, 2.5}, {3.0, 4.5, 2.5}});
  EXPECT_TRUE(cut.incise(along).edit.empty());
  EXPECT_EQ(fingerprint(cut.body), before);
}

TEST(Split, WhatMeetsNoEdgeIsEmpty) {
  const CutBody cut(cubes({6, 3, 2}), IncisionMethod::split);
  for (const CutSurface& surface : {across_x(2.4, 3.2, 4.0, -0.5, 2.5), across_x(7.0, -0.5, 3.5, -0.5, 2.5),
                                    across_x(2.4, 0.1, 0.15, 0.02, 0.05), CutSurface{}}) {
    const Incision incision = cut.incise(surface);
    EXPECT_TRUE(incision.edit.empty());
    EXPECT_EQ(incision.edges_cut, 0);
  }
}

// A cut that branches off another: three parts meet at the nodes of the first.
TEST(Split, CutsMeet) {
  CutBody cut(cubes({6, 4, 2}), IncisionMethod::split);
  cut.cut(across_x(3.0, -0.5, 4.5, -0.5, 2.5));
  const Incision incision = cut.cut(strip({{3.0, 2, -0.5}, {3.0, 2, 2.5}}, {{6.5, 2, -0.5}, {6.5, 2, 2.5}}));
  EXPECT_EQ(incision.edit.copied.size(), 4U * 3U);  // x = 3 .. 6; those at x = 3 are of the right half
  const Pieces pieces = find_pieces(cut.body, cut.held);
  EXPECT_EQ(pieces.count(), 3U);
  for (std::size_t node = 0; node < cut.body.mesh().node_count(); ++node) {
    std::set<std::int32_t> around;
    for (const TetId tet : cut.body.tets_around(NodeId(node))) around.insert(pieces.of_tet[tet.index()]);
    EXPECT_EQ(around.size(), 1U);  // nothing hangs on by a node
  }
  expect_manifold_faces(cut.body);
}

}  // namespace
}  // namespace rhexis::fracture::test
