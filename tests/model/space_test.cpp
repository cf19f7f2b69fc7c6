#include "model/space.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <utility>

#include <Eigen/Geometry>

#include "mesh/surface.h"
#include "tests/model/test_bodies.h"

namespace rhexis::model {
namespace {

using test::kuhn_box;

TEST(Edges, AreEveryPairOfEveryTetOnceInAscendingOrder) {
  const mesh::TetMesh mesh = kuhn_box({1.0, 2.0, 3.0}, {2, 3, 1}, 0.2);
  const EdgeTable table = find_edges(mesh);
  std::set<std::pair<NodeId, NodeId>> oracle;
  for (const mesh::Tet& tet : mesh.tets) {
    for (const NodeId a : tet) {
      for (const NodeId b : tet) {
        if (a < b) oracle.emplace(a, b);
      }
    }
  }
  ASSERT_EQ(table.edges.size(), oracle.size());
  auto expected = oracle.begin();
  for (const auto& [a, b] : table.edges) EXPECT_EQ(std::pair(a, b), *expected++);
  for (std::size_t t = 0; t < mesh.tet_count(); ++t) {
    for (std::size_t e = 0; e < 6; ++e) {
      const NodeId a = mesh.tets[t][static_cast<std::size_t>(mesh::kTetEdges[e][0])];
      const NodeId b = mesh.tets[t][static_cast<std::size_t>(mesh::kTetEdges[e][1])];
      const auto& edge = table.edges[static_cast<std::size_t>(table.of_tet[t][e])];
      EXPECT_EQ(edge[0], std::min(a, b));
      EXPECT_EQ(edge[1], std::max(a, b));
    }
  }
}

TEST(Edges, OfABallObeyEuler) {
  const mesh::TetMesh mesh = kuhn_box({1.0, 1.0, 1.0}, {3, 2, 4});
  const mesh::FaceTable faces = mesh::find_faces(mesh);
  const auto euler = static_cast<int>(mesh.node_count()) - static_cast<int>(find_edges(mesh).edges.size()) +
                     static_cast<int>(faces.interior.size() + faces.boundary.size()) -
                     static_cast<int>(mesh.tet_count());
  EXPECT_EQ(euler, 1);
}

TEST(P1Space, IsTheMesh) {
  const mesh::TetMesh mesh = kuhn_box({1.0, 1.0, 1.0}, {2, 1, 1});
  const DisplacementSpace space = make_p1_space(mesh);
  EXPECT_EQ(space.order, 1);
  EXPECT_EQ(space.nodes, mesh.nodes);
  EXPECT_EQ(space.vertex_count(), mesh.node_count());
  EXPECT_EQ(space.dof_count(), 3 * mesh.node_count());
  ASSERT_EQ(space.connectivity.size(), 4 * mesh.tet_count());
  for (std::size_t t = 0; t < mesh.tet_count(); ++t) {
    for (std::size_t a = 0; a < 4; ++a) EXPECT_EQ(space.connectivity[4 * t + a], mesh.tets[t][a].value());
  }
}

TEST(P2Space, HasANodeAtTheMiddleOfEveryEdge) {
  const mesh::TetMesh mesh = kuhn_box({1.0, 2.0, 1.0}, {2, 2, 2}, 0.2);
  const DisplacementSpace space = make_p2_space(mesh);
  EXPECT_EQ(space.order, 2);
  EXPECT_EQ(space.edges, find_edges(mesh).edges);
  EXPECT_EQ(space.node_count(), mesh.node_count() + space.edges.size());
  EXPECT_EQ(space.vertex_count(), mesh.node_count());
  for (std::size_t t = 0; t < mesh.tet_count(); ++t) {
    const std::int32_t* tet = &space.connectivity[10 * t];
    const auto x = mesh::corners(mesh, TetId(t));
    for (std::size_t a = 0; a < 4; ++a) EXPECT_EQ(tet[a], mesh.tets[t][a].value());
    for (std::size_t e = 0; e < 6; ++e) {
      const Vec3 middle = 0.5 * (x[static_cast<std::size_t>(mesh::kTetEdges[e][0])] +
                                 x[static_cast<std::size_t>(mesh::kTetEdges[e][1])]);
      EXPECT_LT((space.nodes[static_cast<std::size_t>(tet[4 + e])] - middle).norm(), 1e-15);
    }
  }
}

TEST(NodesOfSet, TakesMiddlesWhoseEndsAreBothInTheSet) {
  const mesh::TetMesh mesh = kuhn_box({1.0, 1.0, 2.0}, {2, 2, 4});
  std::vector<NodeId> side = test::nodes_on_plane(mesh, 2, 2.0);
  ASSERT_EQ(side.size(), 9U);
  std::reverse(side.begin(), side.end());
  side.push_back(side.front());  // neither order nor a repetition matters

  const std::vector<std::int32_t> p1 = nodes_of_set(make_p1_space(mesh), side);
  EXPECT_EQ(p1.size(), 9U);
  EXPECT_TRUE(std::is_sorted(p1.begin(), p1.end()));

  const DisplacementSpace space = make_p2_space(mesh);
  std::vector<std::int32_t> on_plane;
  for (std::size_t i = 0; i < space.node_count(); ++i) {
    if (std::abs(space.nodes[i].z() - 2.0) < 1e-9) on_plane.push_back(static_cast<std::int32_t>(i));
  }
  EXPECT_EQ(on_plane.size(), 25U);  // 5 x 5: the side's nodes and middles
  EXPECT_EQ(nodes_of_set(space, side), on_plane);
}

TEST(NodesOfFace, RunRoundTheOutwardNormalWithMiddlesBetween) {
  const mesh::TetMesh mesh = test::one_tet();
  const DisplacementSpace p1 = make_p1_space(mesh);
  const DisplacementSpace p2 = make_p2_space(mesh);
  const Vec3 centre = 0.25 * (mesh.nodes[0] + mesh.nodes[1] + mesh.nodes[2] + mesh.nodes[3]);
  for (std::int8_t vertex = 0; vertex < 4; ++vertex) {
    const mesh::TetFace face{TetId(0), vertex};
    const auto n = nodes_of_face(p2, face);
    const auto x = [&](std::size_t i) { return p2.nodes[static_cast<std::size_t>(n[i])]; };
    EXPECT_GT((x(1) - x(0)).cross(x(2) - x(0)).dot(x(0) - centre), 0.0);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NE(n[i], vertex);
      EXPECT_LT((x(3 + i) - 0.5 * (x(i) + x((i + 1) % 3))).norm(), 1e-15);
    }
    const auto linear = nodes_of_face(p1, face);
    EXPECT_TRUE(std::equal(n.begin(), n.begin() + 3, linear.begin()));
    EXPECT_EQ(linear[3], -1);
  }
}

}  // namespace
}  // namespace rhexis::model
