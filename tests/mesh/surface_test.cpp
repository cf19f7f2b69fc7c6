#include "mesh/surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include <Eigen/Dense>

#include "base/clock.h"
#include "mesh/generate.h"

namespace rhexis::mesh {
namespace {

/// The slow obvious way: a map from the nodes of each face to who claims it.
std::map<std::set<NodeId>, std::vector<TetFace>> claims_of(const TetMesh& mesh) {
  std::map<std::set<NodeId>, std::vector<TetFace>> claims;
  for (std::size_t t = 0; t < mesh.tet_count(); ++t)
    for (std::int8_t k = 0; k < 4; ++k) {
      const auto nodes = face_nodes(mesh, {TetId(t), k});
      claims[{nodes.begin(), nodes.end()}].push_back({TetId(t), k});
    }
  return claims;
}

void expect_faces_as_counted_by_hand(const TetMesh& mesh) {
  std::vector<TetFace> boundary;
  std::vector<TetFace> non_manifold;
  std::vector<std::pair<TetFace, TetFace>> interior;
  for (const auto& [nodes, faces] : claims_of(mesh)) {
    if (faces.size() == 1) boundary.push_back(faces[0]);
    if (faces.size() == 2) interior.emplace_back(faces[0], faces[1]);
    if (faces.size() > 2) non_manifold.insert(non_manifold.end(), faces.begin(), faces.end());
  }
  std::sort(boundary.begin(), boundary.end());
  std::sort(interior.begin(), interior.end());
  std::sort(non_manifold.begin(), non_manifold.end());

  const FaceTable table = find_faces(mesh);
  EXPECT_EQ(table.boundary, boundary);
  EXPECT_EQ(table.non_manifold, non_manifold);
  ASSERT_EQ(table.interior.size(), interior.size());
  for (std::size_t i = 0; i < interior.size(); ++i) {
    EXPECT_EQ(table.interior[i].first, interior[i].first);
    EXPECT_EQ(table.interior[i].second, interior[i].second);
    EXPECT_LT(table.interior[i].first.tet, table.interior[i].second.tet);
  }
}

TEST(Surface, FacesOfGeneratedBodies) {
  expect_faces_as_counted_by_hand(make_structured_box({1, 2, 3}, {3, 4, 5}));
  expect_faces_as_counted_by_hand(make_bar({Vec3(1, 1, 2)}, 500).value());
  expect_faces_as_counted_by_hand(make_tube({.wall = 0.002}, 700).value());
}

TEST(Surface, FaceOfThreeTetsIsNeitherInteriorNorBoundary) {
  TetMesh mesh;
  mesh.nodes = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, -1}, {1, 1, 1}};
  for (const int apex : {3, 4, 5}) mesh.tets.push_back({NodeId(0), NodeId(1), NodeId(2), NodeId(apex)});
  expect_faces_as_counted_by_hand(mesh);
  const FaceTable table = find_faces(mesh);
  EXPECT_EQ(table.non_manifold.size(), 3u);
  EXPECT_EQ(table.boundary.size(), 9u);
  EXPECT_TRUE(table.interior.empty());
}

TEST(Surface, NothingHasNoFaces) {
  const FaceTable table = find_faces(TetMesh{});
  EXPECT_TRUE(table.interior.empty() && table.boundary.empty() && table.non_manifold.empty());
}

TEST(Surface, BoundaryIsClosed) {
  // The outward area vectors of a closed surface add up to zero, whatever its form.
  const TetMesh mesh = make_tube({.wall = 0.001, .bend = 70.0}, 2000).value();
  Vec3 sum = Vec3::Zero();
  double area = 0.0;
  for (const TetFace face : find_faces(mesh).boundary) {
    const auto [a, b, c] = face_nodes(mesh, face);
    sum += 0.5 * (mesh.node(b) - mesh.node(a)).cross(mesh.node(c) - mesh.node(a));
    area += face_area(mesh, face);
  }
  // Some thousand terms of 1e-3 of the area: rounding stays far below 1e-12 of the whole.
  EXPECT_LT(sum.norm(), 1e-12 * area);
}

TEST(Surface, AreaOfAFace) {
  const TetMesh mesh = make_structured_box({2, 3, 5}, {1, 1, 1});
  double area = 0.0;
  for (const TetFace face : find_faces(mesh).boundary) area += face_area(mesh, face);
  EXPECT_DOUBLE_EQ(area, 2.0 * (2 * 3 + 3 * 5 + 5 * 2));
}

TEST(Surface, IsFast) {
  const TetMesh mesh = make_bar({Vec3(1, 1, 1)}, 20000).value();
  ASSERT_GT(mesh.tet_count(), 100'000u);
  double best = 1.0;
  for (int i = 0; i < 5; ++i) {
    const Stopwatch watch;
    EXPECT_FALSE(find_faces(mesh).interior.empty());
    best = std::min(best, watch.seconds());
  }
  // Measured: 0.03 s. The bound tells n log n from n^2 even on a busy machine.
  EXPECT_LT(best, 0.3);
}

}  // namespace
}  // namespace rhexis::mesh
