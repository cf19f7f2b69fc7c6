#include "mesh/torn_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <vector>

#include "mesh/surface.h"
#include "tests/support/kuhn_box.h"

namespace rhexis::mesh {
namespace {

/// Everything that an edit can change, to the bit.
std::vector<std::uint64_t> bits_of(const TornMesh& body) {
  std::vector<std::uint64_t> out;
  for (const Vec3& x : body.mesh().nodes) {
    for (int c = 0; c < 3; ++c) out.push_back(std::bit_cast<std::uint64_t>(x[c]));
  }
  for (std::size_t t = 0; t < body.mesh().tet_count(); ++t) {
    for (const NodeId node : body.mesh().tets[t]) out.push_back(node.index());
    out.push_back((body.is_alive(TetId(t)) ? 1U : 0U) + (body.is_frozen(TetId(t)) ? 2U : 0U));
  }
  for (std::size_t n = 0; n < body.mesh().node_count(); ++n) {
    out.push_back(body.original(NodeId(n)).index());
    for (const TetId tet : body.tets_around(NodeId(n))) out.push_back(tet.index());
  }
  return out;
}

/// Removes a tet, moves a node, gives a third tet a copy of that node and freezes a fourth.
MeshEdit some_edit(const TornMesh& body, std::size_t seed) {
  MeshEdit edit;
  std::vector<TetId> alive;
  for (std::size_t t = 0; t < body.mesh().tet_count(); ++t) {
    if (body.is_solved(TetId(t))) alive.emplace_back(t);
  }
  edit.removed = {alive[seed % alive.size()]};
  const TetId rewired = alive[(seed + 5) % alive.size()];
  edit.frozen = {alive[(seed + 9) % alive.size()]};
  const NodeId node = body.mesh().tet(rewired)[1];
  edit.moved = {{node, body.mesh().node(node), body.mesh().node(node) + Vec3(0.01, -0.02, 0.03)}};
  edit.copied = {node};
  Tet after = body.mesh().tet(rewired);
  after[1] = NodeId(body.mesh().node_count());
  edit.rewired = {{rewired, body.mesh().tet(rewired), after}};
  return edit;
}

TEST(TornMesh, BeginsWhole) {
  const TetMesh mesh = test::make_kuhn_box({.cells = {2, 2, 2}});
  const TornMesh body(mesh);
  EXPECT_EQ(body.topology(), 0U);
  EXPECT_EQ(body.volume(), total_volume(mesh));
  std::size_t corners = 0;
  for (std::size_t n = 0; n < mesh.node_count(); ++n) {
    const auto around = body.tets_around(NodeId(n));
    EXPECT_TRUE(std::is_sorted(around.begin(), around.end()));
    EXPECT_EQ(body.original(NodeId(n)), NodeId(n));
    corners += around.size();
  }
  EXPECT_EQ(corners, 4 * mesh.tet_count());
}

TEST(TornMesh, AppliesWhatAnEditSays) {
  TornMesh body(test::make_kuhn_box({.cells = {2, 2, 2}}));
  const std::size_t nodes = body.mesh().node_count();
  const MeshEdit edit = some_edit(body, 7);
  body.apply(edit);
  EXPECT_EQ(body.topology(), 1U);
  EXPECT_FALSE(body.is_alive(edit.removed[0]));
  EXPECT_TRUE(body.is_alive(edit.frozen[0]));
  EXPECT_FALSE(body.is_solved(edit.frozen[0]));
  ASSERT_EQ(body.mesh().node_count(), nodes + 1);
  EXPECT_EQ(body.original(NodeId(nodes)), edit.copied[0]);
  EXPECT_EQ(body.mesh().node(NodeId(nodes)), edit.moved[0].to);
  ASSERT_EQ(body.tets_around(NodeId(nodes)).size(), 1U);
  EXPECT_EQ(body.tets_around(NodeId(nodes))[0], edit.rewired[0].tet);
}

TEST(TornMesh, ANodeIsInTheSolveWhileOneOfItsTetsIs) {
  TornMesh body(test::make_kuhn_box({.cells = {2, 2, 2}}));
  const NodeId node = body.mesh().tets[0][0];
  MeshEdit edit;
  edit.frozen.assign(body.tets_around(node).begin(), body.tets_around(node).end());
  const TetId last = edit.frozen.back();
  edit.frozen.pop_back();
  body.apply(edit);
  EXPECT_TRUE(body.is_solved(node));
  MeshEdit rest;
  rest.frozen = {last};
  body.apply(rest);
  EXPECT_TRUE(body.is_alive(node));
  EXPECT_FALSE(body.is_solved(node));
}

TEST(TornMesh, UndoReturnsEveryBitOfEveryTopology) {
  TornMesh body(test::make_kuhn_box({.cells = {3, 3, 2}}));
  std::vector<std::vector<std::uint64_t>> before;
  for (std::size_t k = 0; k < 12; ++k) {
    before.push_back(bits_of(body));
    body.apply(some_edit(body, 13 * k + 3));
    EXPECT_NE(bits_of(body), before.back());
  }
  while (body.topology() > 0) {
    body.undo();
    EXPECT_EQ(bits_of(body), before[body.topology()]) << body.topology();
  }
}

TEST(TornMesh, SurfaceOfTheSolveIsThatOfAMeshOfThoseTets) {
  TornMesh body(test::make_kuhn_box({.cells = {3, 3, 2}}));
  EXPECT_EQ(solved_surface(body), find_faces(body.mesh()).boundary);
  for (std::size_t k = 0; k < 6; ++k) body.apply(some_edit(body, 29 * k + 3));
  TetMesh solved;  // with the tets in the solve alone, by the table of faces that whole meshes have
  solved.nodes = body.mesh().nodes;
  std::vector<TetId> number;
  for (std::size_t t = 0; t < body.mesh().tet_count(); ++t) {
    if (!body.is_solved(TetId(t))) continue;
    solved.tets.push_back(body.mesh().tets[t]);
    number.emplace_back(t);
  }
  std::vector<TetFace> expected = find_faces(solved).boundary;
  for (TetFace& face : expected) face.tet = number[face.tet.index()];
  EXPECT_EQ(solved_surface(body), expected);
  EXPECT_GT(expected.size(), find_faces(body.mesh()).boundary.size());
}

TEST(TornMesh, RefusesAnEditThatDoesNotFit) {
  TornMesh body(test::make_kuhn_box({.cells = {2, 2, 2}}));
  const MeshEdit edit = some_edit(body, 7);
  body.apply(edit);
  EXPECT_DEATH(body.apply(edit), "is not where the edit found it|is removed twice");
}

}  // namespace
}  // namespace rhexis::mesh
