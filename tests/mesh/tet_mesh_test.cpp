#include "mesh/tet_mesh.h"

#include <gtest/gtest.h>

#include <set>

#include <Eigen/Dense>

namespace rhexis::mesh {
namespace {

/// Two tets on both sides of the triangle 0 1 2, the second one twice as high.
TetMesh two_tets() {
  TetMesh mesh;
  mesh.nodes = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, -2}};
  mesh.tets = {{NodeId(0), NodeId(1), NodeId(2), NodeId(3)}, {NodeId(0), NodeId(2), NodeId(1), NodeId(4)}};
  mesh.node_sets = {{"base", {NodeId(0), NodeId(1), NodeId(2)}}};
  mesh.face_sets = {{"slope", {{TetId(0), 0}}}};
  return mesh;
}

TEST(TetMesh, FindsSetsByName) {
  const TetMesh mesh = two_tets();
  ASSERT_NE(mesh.find_node_set("base"), nullptr);
  EXPECT_EQ(mesh.find_node_set("base")->nodes.size(), 3u);
  EXPECT_EQ(mesh.find_node_set("slope"), nullptr) << "node sets and face sets have names of their own";
  ASSERT_NE(mesh.find_face_set("slope"), nullptr);
  EXPECT_EQ(mesh.find_face_set("base"), nullptr);
  EXPECT_EQ(TetMesh{}.find_face_set(""), nullptr);
}

TEST(TetMesh, MeasuresVolumes) {
  TetMesh mesh = two_tets();
  EXPECT_DOUBLE_EQ(signed_volume(mesh, TetId(0)), 1.0 / 6.0);
  EXPECT_DOUBLE_EQ(signed_volume(mesh, TetId(1)), 1.0 / 3.0);
  EXPECT_DOUBLE_EQ(total_volume(mesh), 0.5);
  std::swap(mesh.tets[1][0], mesh.tets[1][1]);
  EXPECT_DOUBLE_EQ(signed_volume(mesh, TetId(1)), -1.0 / 3.0);
}

TEST(TetMesh, KnowsTheLongestEdge) {
  const TetMesh mesh = two_tets();
  EXPECT_DOUBLE_EQ(longest_edge(mesh, TetId(0)), std::sqrt(2.0));
  EXPECT_DOUBLE_EQ(longest_edge(mesh, TetId(1)), std::sqrt(5.0));
}

TEST(TetMesh, CornersFollowTheOrderOfTheTet) {
  const TetMesh mesh = two_tets();
  const auto x = corners(mesh, TetId(1));
  EXPECT_EQ(x[0], Vec3(0, 0, 0));
  EXPECT_EQ(x[1], Vec3(0, 1, 0));
  EXPECT_EQ(x[2], Vec3(1, 0, 0));
  EXPECT_EQ(x[3], Vec3(0, 0, -2));
}

TEST(TetMesh, FacesAreSeenCounterClockwiseFromOutside) {
  const TetMesh mesh = two_tets();
  for (std::size_t t = 0; t < mesh.tet_count(); ++t)
    for (std::int8_t k = 0; k < 4; ++k) {
      const auto [a, b, c] = face_nodes(mesh, {TetId(t), k});
      const Vec3 normal = (mesh.node(b) - mesh.node(a)).cross(mesh.node(c) - mesh.node(a));
      const NodeId opposite = mesh.tets[t][static_cast<std::size_t>(k)];
      EXPECT_LT(normal.dot(mesh.node(opposite) - mesh.node(a)), 0.0) << "tet " << t << " face " << int{k};
      for (const NodeId n : {a, b, c}) EXPECT_NE(n, opposite);
    }
}

TEST(TetMesh, EveryEdgeIsListedOnce) {
  std::set<std::array<int, 2>> edges;
  for (const auto& [i, j] : kTetEdges) {
    EXPECT_LT(i, j);
    EXPECT_TRUE(edges.insert({i, j}).second);
  }
  EXPECT_EQ(edges.size(), 6u);
}

TEST(TetMesh, BoundingBoxHoldsAllNodes) {
  const BoundingBox box = bounding_box(two_tets());
  EXPECT_EQ(box.from, Vec3(0, 0, -2));
  EXPECT_EQ(box.to, Vec3(1, 1, 1));
  EXPECT_EQ(box.size(), Vec3(1, 1, 3));
  EXPECT_EQ(bounding_box(TetMesh{}).size(), Vec3::Zero());
}

}  // namespace
}  // namespace rhexis::mesh
