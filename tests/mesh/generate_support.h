#pragma once

/// What holds for every generated body, and the measure of preferred diagonals.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include <Eigen/Dense>

#include "base/hash.h"
#include "mesh/generate.h"
#include "mesh/quality.h"
#include "mesh/surface.h"
#include "mesh/validate.h"

namespace rhexis::mesh {

inline std::uint64_t fingerprint(const TetMesh& mesh) {
  Hash hash;
  for (const Vec3& x : mesh.nodes) hash.add(std::span<const double>(x.data(), 3));
  for (const Tet& t : mesh.tets) hash.add(std::span<const NodeId>(t));
  for (const FaceSet& set : mesh.face_sets)
    for (const TetFace face : set.faces) {
      const std::array<std::int32_t, 2> numbers{face.tet.value(), face.vertex};
      hash.add(std::span<const std::int32_t>(numbers));
    }
  return hash.value();
}

inline double area_of(const TetMesh& mesh, std::span<const TetFace> faces) {
  double area = 0.0;
  for (const TetFace face : faces) area += face_area(mesh, face);
  return area;
}

/// Conforming, positively oriented, one piece, and each boundary face in exactly one face set, whose nodes are the node
/// set of the same name; sets ascending without duplicates.
inline void expect_sound(const TetMesh& mesh) {
  for (const Defect& defect : find_defects(mesh)) ADD_FAILURE() << defect.what;
  ASSERT_EQ(mesh.node_sets.size(), mesh.face_sets.size());
  std::multiset<TetFace> covered;
  for (const FaceSet& set : mesh.face_sets) {
    EXPECT_FALSE(set.faces.empty()) << set.name;
    EXPECT_TRUE(std::is_sorted(set.faces.begin(), set.faces.end())) << set.name;
    covered.insert(set.faces.begin(), set.faces.end());
    std::set<NodeId> nodes;
    for (const TetFace face : set.faces)
      for (const NodeId n : face_nodes(mesh, face)) nodes.insert(n);
    const NodeSet* node_set = mesh.find_node_set(set.name);
    ASSERT_NE(node_set, nullptr) << set.name;
    EXPECT_EQ(node_set->nodes, std::vector<NodeId>(nodes.begin(), nodes.end())) << set.name;
  }
  const std::vector<TetFace> boundary = find_faces(mesh).boundary;
  EXPECT_EQ(std::vector<TetFace>(covered.begin(), covered.end()), boundary);
}

/// A box with sets: also its volume, and area and place of each side, to rounding. A hanging face would add its area to
/// the boundary, a gap would take volume away.
inline void expect_box(const TetMesh& mesh, const Vec3& size) {
  expect_sound(mesh);
  const double volume = size.prod();
  long double sum = 0.0;  // so that only the rounding of the single volumes is left
  for (std::size_t t = 0; t < mesh.tet_count(); ++t) sum += signed_volume(mesh, TetId(t));
  EXPECT_NEAR(static_cast<double>(sum), volume, 1e-13 * volume);
  const BoundingBox box = bounding_box(mesh);
  EXPECT_EQ(box.from, Vec3::Zero());
  EXPECT_EQ(box.to, size);
  const char* const names[3][2] = {{"-x", "+x"}, {"-y", "+y"}, {"-z", "+z"}};
  for (int axis = 0; axis < 3; ++axis)
    for (int upper = 0; upper < 2; ++upper) {
      const FaceSet* side = mesh.find_face_set(names[axis][upper]);
      ASSERT_NE(side, nullptr);
      const double area = volume / size[axis];
      // A running sum of up to 1e5 positive terms.
      EXPECT_NEAR(area_of(mesh, side->faces), area, 1e-12 * area) << side->name;
      for (const NodeId n : mesh.find_node_set(side->name)->nodes)
        EXPECT_EQ(mesh.node(n)[axis], upper ? size[axis] : 0.0) << side->name;
    }
}

inline std::set<std::pair<NodeId, NodeId>> edges_of(const TetMesh& mesh) {
  std::set<std::pair<NodeId, NodeId>> edges;
  for (const Tet& tet : mesh.tets)
    for (const auto& [i, j] : kTetEdges)
      edges.insert(std::minmax(tet[static_cast<std::size_t>(i)], tet[static_cast<std::size_t>(j)]));
  return edges;
}

/// For the pairs xy, yz, zx: the sum of e_i e_j / |e|^2 over all edges e, in units of what coin-tossing the sign of
/// each term would give (one standard deviation). Mirroring an axis turns the sign, so a mesh without a preferred
/// diagonal has values of the order of 1; a mesh that repeats one diagonal grows like the root of its edge count.
inline Vec3 diagonal_bias(const TetMesh& mesh) {
  Vec3 sum = Vec3::Zero();
  Vec3 square = Vec3::Zero();
  for (const auto& [a, b] : edges_of(mesh)) {
    const Vec3 e = mesh.node(b) - mesh.node(a);
    const Vec3 products = Vec3(e[0] * e[1], e[1] * e[2], e[2] * e[0]) / e.squaredNorm();
    sum += products;
    square += products.cwiseAbs2();
  }
  return sum.cwiseQuotient(square.cwiseSqrt());
}

inline void expect_no_preferred_diagonal(const TetMesh& mesh) {
  constexpr double kDeviations = 4.0;
  EXPECT_LT(diagonal_bias(mesh).cwiseAbs().maxCoeff(), kDeviations) << diagonal_bias(mesh).transpose();
}

/// "a bar of this shape cannot have 12 nodes (8 and 14 can be had)": the counts in the brackets.
inline std::vector<int> counts_offered(const Error& error) {
  std::vector<int> counts;
  int number = 0;
  bool inside = false;
  for (const char c : error.remedy + ' ') {
    if (c >= '0' && c <= '9') {
      number = 10 * number + (c - '0');
      inside = true;
    } else if (inside) {
      counts.push_back(std::exchange(number, 0));
      inside = false;
    }
  }
  return counts;
}

/// make(nodes) fails; its error names `nodes` and counts with which make succeeds (of large ones that is believed).
template <class Make>
void expect_error_offers_counts(const Make& make, int nodes) {
  const Expected<TetMesh> mesh = make(nodes);
  ASSERT_FALSE(mesh.has_value());
  EXPECT_THAT(mesh.error().what, testing::HasSubstr(std::to_string(nodes)));
  const std::vector<int> counts = counts_offered(mesh.error());
  ASSERT_FALSE(counts.empty()) << mesh.error().message();
  for (const int count : counts)
    if (count < 100'000) {
      EXPECT_TRUE(make(count).has_value()) << count;
    }
}

}  // namespace rhexis::mesh
