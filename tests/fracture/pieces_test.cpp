#include "fracture/pieces.h"

#include <gtest/gtest.h>

#include "mesh/generate.h"
#include "tests/fracture/cut_support.h"
#include "tests/support/kuhn_box.h"

namespace rhexis::fracture::test {
namespace {

CutBody bar(int nodes = 400) { return CutBody(mesh::make_bar({Vec3(4.0, 1.0, 1.0)}, nodes).value()); }

CutSurface across(double x) { return across_x(x, -1.0, 2.0, -1.0, 2.0); }

TEST(Pieces, AnIntactBodyIsOne) {
  CutBody cut = bar();
  const Pieces loose = find_pieces(cut.body, cut.held);
  EXPECT_EQ(loose.of_tet, std::vector<std::int32_t>(cut.body.mesh().tet_count(), 0));
  EXPECT_EQ(loose.supported, std::vector<std::uint8_t>{0});
  EXPECT_EQ(unsupported_tets(cut.body, loose).size(), cut.body.mesh().tet_count());
  cut.hold([](const Vec3& x) { return x[0] == 0.0; });
  const Pieces clamped = find_pieces(cut.body, cut.held);
  EXPECT_EQ(clamped.supported, std::vector<std::uint8_t>{1});
  EXPECT_TRUE(unsupported_tets(cut.body, clamped).empty());
}

TEST(Pieces, WhatIsCutOffIsNotSupported) {
  CutBody cut = bar();
  cut.hold([](const Vec3& x) { return x[0] == 0.0; });
  cut.cut(across(2.1));
  const Pieces pieces = find_pieces(cut.body, cut.held);
  ASSERT_EQ(pieces.count(), 2U);
  const std::vector<TetId> off = unsupported_tets(cut.body, pieces);
  ASSERT_FALSE(off.empty());
  std::size_t beyond = 0;
  for (std::size_t t = 0; t < cut.body.mesh().tet_count(); ++t) {
    if (!cut.body.is_alive(TetId(t))) {
      EXPECT_EQ(pieces.of_tet[t], -1);
      continue;
    }
    Vec3 centre = Vec3::Zero();
    for (const Vec3& x : mesh::corners(cut.body.mesh(), TetId(t))) centre += 0.25 * x;
    const bool right = centre[0] > 2.1;
    beyond += right ? 1 : 0;
    EXPECT_EQ(pieces.supported[static_cast<std::size_t>(pieces.of_tet[t])], right ? 0 : 1);
  }
  EXPECT_EQ(off.size(), beyond);

  mesh::MeshEdit freeze;
  freeze.frozen = off;
  cut.apply(freeze);
  EXPECT_TRUE(unsupported_tets(cut.body, find_pieces(cut.body, cut.held)).empty());
}

// A piece between two that are held; then one with both ends held apart.
TEST(Pieces, EachIsJudgedByItsOwnSupports) {
  CutBody cut = bar();
  cut.hold([](const Vec3& x) { return x[0] == 0.0 || x[0] == 4.0; });
  cut.cut(across(1.1));
  EXPECT_EQ(find_pieces(cut.body, cut.held).supported, (std::vector<std::uint8_t>{1, 1}));
  cut.cut(across(2.7));
  const Pieces pieces = find_pieces(cut.body, cut.held);
  ASSERT_EQ(pieces.count(), 3U);
  EXPECT_EQ(std::count(pieces.supported.begin(), pieces.supported.end(), 0), 1);
  const std::vector<TetId> middle = unsupported_tets(cut.body, pieces);
  EXPECT_EQ(std::count(pieces.of_tet.begin(), pieces.of_tet.end(), pieces.of_tet[middle.front().index()]),
            static_cast<std::ptrdiff_t>(middle.size()));
}

/// Two tets that share `shared` nodes, 1 to 3, and are far from flat.
mesh::TetMesh two_tets(int shared) {
  mesh::TetMesh mesh;
  mesh.nodes = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.3, 0.3, 1}, {0.3, 0.3, -1}, {2, 0.2, -0.5}, {1, 1.5, -0.6}};
  mesh.tets = {{NodeId(0), NodeId(1), NodeId(2), NodeId(3)}};
  if (shared == 3) mesh.tets.push_back({NodeId(0), NodeId(2), NodeId(1), NodeId(4)});
  if (shared == 2) mesh.tets.push_back({NodeId(1), NodeId(2), NodeId(5), NodeId(4)});
  if (shared == 1) mesh.tets.push_back({NodeId(1), NodeId(4), NodeId(5), NodeId(6)});
  for (mesh::Tet& tet : mesh.tets)
    if (mesh::signed_volume(mesh, TetId(static_cast<std::size_t>(&tet - mesh.tets.data()))) < 0.0)
      std::swap(tet[1], tet[2]);
  return mesh;
}

TEST(Pieces, ASharedFaceSupportsAnEdgeIsAHingeANodeAJoint) {
  for (const int shared : {1, 2, 3}) {
    CutBody cut(two_tets(shared));
    cut.hold([](const Vec3& x) { return x[2] >= 0.0 && x[0] <= 1.0; });  // the first tet
    const Pieces pieces = find_pieces(cut.body, cut.held);
    EXPECT_EQ(pieces.count(), shared == 3 ? 1U : 2U);
    EXPECT_EQ(pieces.supported.back(), shared == 3 ? 1 : 0) << shared;
    EXPECT_EQ(pieces.supported.front(), 1);
  }
}

// The second tet hangs by a hinge; one component at one of its other nodes holds it.
TEST(Pieces, SupportsAndNeighboursAddUp) {
  CutBody cut(two_tets(2));
  cut.hold([](const Vec3& x) { return x[2] >= 0.0 && x[0] <= 1.0; });
  cut.held[3 * 4 + 0] = 1;
  EXPECT_EQ(find_pieces(cut.body, cut.held).supported, (std::vector<std::uint8_t>{1, 1}));
  // Now the second is the one that stands, and the first turns about the edge between them ...
  for (const std::size_t node : {0, 3}) std::fill_n(cut.held.begin() + static_cast<std::ptrdiff_t>(3 * node), 3, 0);
  EXPECT_EQ(find_pieces(cut.body, cut.held).supported, (std::vector<std::uint8_t>{0, 1}));
  cut.held[3 * 0 + 2] = 1;  // ... unless one component more is held
  EXPECT_EQ(find_pieces(cut.body, cut.held).supported, (std::vector<std::uint8_t>{1, 1}));
}

/// A tower of boxes, each on `corners` corners of the one below, which is no face of either; the lowest box has the
/// highest numbers, and stands at z = 0.
mesh::TetMesh tower(std::size_t corners) {
  rhexis::test::KuhnGrid grid;
  grid.cells = {2, 2, 3};
  grid.jitter = Vec3::Zero();
  const mesh::TetMesh box = rhexis::test::make_kuhn_box(grid);  // node (i, j, k) is 4 (3 i + j) + k
  const std::array<std::size_t, 3> corner{0, 4 * 2, 4 * 6};     // at the bottom; 3 more at the top
  mesh::TetMesh tower;
  for (std::size_t level = 3; level-- > 0;) {
    const std::size_t offset = tower.node_count();
    for (const Vec3& x : box.nodes) tower.nodes.push_back(x + static_cast<double>(3 * level) * Vec3::UnitZ());
    for (mesh::Tet tet : box.tets) {
      for (NodeId& node : tet) {
        const auto at = std::find(corner.begin(), corner.begin() + corners, node.index() - 3);
        // The top corners of this box are the bottom corners of the one above, which has come before.
        node = at != corner.begin() + corners && level < 2 ? NodeId(offset - box.node_count() + *at)
                                                           : NodeId(offset + node.index());
      }
      tower.tets.push_back(tet);
    }
  }
  return tower;
}

TEST(Pieces, SupportIsHandedOn) {
  for (const std::size_t corners : {2U, 3U}) {
    CutBody cut(tower(corners));
    cut.hold([](const Vec3& x) { return x[2] == 0.0; });
    EXPECT_EQ(find_pieces(cut.body, cut.held).supported,
              corners == 3 ? (std::vector<std::uint8_t>{1, 1, 1}) : (std::vector<std::uint8_t>{0, 0, 1}));
  }
}

// All tets at a corner that two boxes share, of both, in one edit: what hung on it is loose, though none of the tets
// that remain were near.
TEST(Pieces, ANodeThatTwoPiecesLoseAtOnceIsMissed) {
  CutBody cut(tower(3));
  cut.hold([](const Vec3& x) { return x[2] == 0.0; });
  Pieces pieces = find_pieces(cut.body, cut.held);
  mesh::MeshEdit edit;
  const auto tets = cut.body.tets_around(NodeId(0));  // the first bottom corner of the top box
  edit.removed.assign(tets.begin(), tets.end());
  cut.apply(edit);
  update_pieces(pieces, cut.body, edit, cut.held);
  EXPECT_EQ(pieces.supported, (std::vector<std::uint8_t>{0, 1, 1}));
  EXPECT_TRUE(pieces == find_pieces(cut.body, cut.held));
}

}  // namespace
}  // namespace rhexis::fracture::test
