#include "mesh/validate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "mesh/generate.h"
#include "mesh/surface.h"

namespace rhexis::mesh {
namespace {

using testing::HasSubstr;

TetMesh box() { return make_structured_box({1, 1, 1}, {2, 2, 2}); }

std::vector<DefectKind> kinds(const std::vector<Defect>& defects) {
  std::vector<DefectKind> result;
  for (const Defect& defect : defects) result.push_back(defect.kind);
  return result;
}

Tet tet_of(int a, int b, int c, int d) { return {NodeId(a), NodeId(b), NodeId(c), NodeId(d)}; }

TEST(Validate, GoodMeshHasNoDefects) {
  EXPECT_TRUE(find_defects(box()).empty());
  EXPECT_TRUE(find_defects(TetMesh{}).empty());
}

TEST(Validate, InvertedTet) {
  TetMesh mesh = box();
  std::swap(mesh.tets[17][0], mesh.tets[17][1]);
  const auto defects = find_defects(mesh);
  ASSERT_EQ(kinds(defects), std::vector{DefectKind::inverted_tet});
  EXPECT_EQ(defects[0].tet, TetId(17));
  EXPECT_FALSE(defects[0].node.valid());
  EXPECT_THAT(defects[0].what, HasSubstr("tet 17"));
}

/// One tet of height `h` over a triangle with longest edge 1.
TetMesh tet_of_height(double h, double scale) {
  TetMesh mesh;
  mesh.nodes = {{0, 0, 0}, {scale, 0, 0}, {0.5 * scale, 0.8 * scale, 0}, {0.5 * scale, 0.3 * scale, h * scale}};
  mesh.tets = {tet_of(0, 1, 2, 3)};
  return mesh;
}

TEST(Validate, FlatIsRelativeToTheLongestEdge) {
  // Also at lengths whose cubes neither fit into a double above nor below.
  for (const double scale : {1e-150, 1e-3, 1.0, 1e150}) {
    EXPECT_TRUE(find_defects(tet_of_height(1.01 * kFlatTet, scale)).empty()) << scale;
    EXPECT_EQ(kinds(find_defects(tet_of_height(0.99 * kFlatTet, scale))), std::vector{DefectKind::flat_tet}) << scale;
    EXPECT_EQ(kinds(find_defects(tet_of_height(-0.99 * kFlatTet, scale))), std::vector{DefectKind::flat_tet}) << scale;
    EXPECT_EQ(kinds(find_defects(tet_of_height(-1.01 * kFlatTet, scale))), std::vector{DefectKind::inverted_tet});
  }
  EXPECT_EQ(kinds(find_defects(tet_of_height(0.0, 1.0))), std::vector{DefectKind::flat_tet});
}

TEST(Validate, TetInOnePointIsFlat) {
  TetMesh mesh = tet_of_height(1.0, 1.0);
  for (Vec3& x : mesh.nodes) x = Vec3(1, 2, 3);
  EXPECT_EQ(kinds(find_defects(mesh)), std::vector{DefectKind::flat_tet});
}

TEST(Validate, DuplicateIsNamedWithItsOriginalAndCausesNothingElse) {
  TetMesh mesh = box();
  const Tet t = mesh.tets[5];
  mesh.tets.push_back({t[1], t[2], t[0], t[3]});  // an even permutation: same orientation
  const auto defects = find_defects(mesh);
  ASSERT_EQ(kinds(defects), std::vector{DefectKind::duplicate_tet});
  EXPECT_EQ(defects[0].tet, TetId(mesh.tet_count() - 1));
  EXPECT_THAT(defects[0].what, HasSubstr("tet 5"));
}

TEST(Validate, RepeatedNode) {
  TetMesh mesh = box();
  mesh.tets.push_back(tet_of(0, 4, 0, 7));
  const auto defects = find_defects(mesh);
  ASSERT_EQ(kinds(defects), std::vector{DefectKind::repeated_node});
  EXPECT_THAT(defects[0].what, HasSubstr("node 0 twice"));
}

TEST(Validate, IndicesOutOfRange) {
  for (const int bad : {-1, 27, std::numeric_limits<int>::max(), std::numeric_limits<int>::min()}) {
    TetMesh mesh = box();
    ASSERT_EQ(mesh.node_count(), 27u);
    mesh.tets.push_back(tet_of(0, 1, 2, bad));
    const auto defects = find_defects(mesh);
    ASSERT_EQ(kinds(defects), std::vector{DefectKind::bad_index}) << bad;
    EXPECT_EQ(defects[0].tet, TetId(40));
  }
}

TEST(Validate, PieceThatTouchesInAnEdgeOnlyIsUnconnected) {
  TetMesh mesh = box();
  const auto first_new = static_cast<int>(mesh.node_count());
  mesh.nodes.insert(mesh.nodes.end(), {{-1, 0, -1}, {-1, 0.5, -1}, {-2, 0, -1}});
  // Nodes 0 and 3 span an edge of the box: (0, 0, 0) and (0, 0.5, 0).
  mesh.tets.push_back(tet_of(0, 3, first_new, first_new + 1));
  mesh.tets.push_back(tet_of(0, 3, first_new + 1, first_new + 2));
  orient_tets(mesh);
  const auto defects = find_defects(mesh);
  ASSERT_FALSE(defects.empty());
  const auto piece = std::find_if(defects.begin(), defects.end(),
                                  [](const Defect& d) { return d.kind == DefectKind::unconnected_tet; });
  ASSERT_NE(piece, defects.end());
  EXPECT_EQ(piece->tet, TetId(40));
  EXPECT_THAT(piece->what, HasSubstr("2 of 42 tets"));
}

TEST(Validate, TheSmallerPieceIsTheDefectWhereverItStands) {
  TetMesh mesh;
  mesh.nodes = {{9, 0, 0}, {10, 0, 0}, {9, 1, 0}, {9, 0, 1}};
  mesh.tets = {tet_of(0, 1, 2, 3)};
  const TetMesh rest = box();
  mesh.nodes.insert(mesh.nodes.end(), rest.nodes.begin(), rest.nodes.end());
  for (const Tet& t : rest.tets)
    mesh.tets.push_back(tet_of(t[0].value() + 4, t[1].value() + 4, t[2].value() + 4, t[3].value() + 4));
  const auto defects = find_defects(mesh);
  ASSERT_EQ(kinds(defects), std::vector{DefectKind::unconnected_tet});
  EXPECT_EQ(defects[0].tet, TetId(0));
}

TEST(Validate, NonManifoldFaceIsOneDefectAndConnectsItsTets) {
  TetMesh mesh;
  mesh.nodes = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, -1}, {1, 1, 1}};
  mesh.tets = {tet_of(0, 1, 2, 3), tet_of(0, 2, 1, 4), tet_of(0, 1, 2, 5)};
  const auto defects = find_defects(mesh);
  ASSERT_EQ(kinds(defects), std::vector{DefectKind::non_manifold_face});
  EXPECT_EQ(defects[0].tet, TetId(0));
  EXPECT_THAT(defects[0].what, HasSubstr("nodes 0, 1, 2 belongs to 3 tets: 0, 1, 2"));
}

TEST(Validate, UnusedNode) {
  TetMesh mesh = box();
  mesh.nodes.emplace_back(5, 5, 5);
  const auto defects = find_defects(mesh);
  ASSERT_EQ(kinds(defects), std::vector{DefectKind::unused_node});
  EXPECT_EQ(defects[0].node, NodeId(27));
  EXPECT_FALSE(defects[0].tet.valid());
}

TEST(Validate, CoordinatesThatAreNoNumbers) {
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    TetMesh mesh = box();
    mesh.nodes[13][1] = bad;
    const auto defects = find_defects(mesh);
    ASSERT_EQ(kinds(defects), std::vector{DefectKind::not_finite});
    EXPECT_EQ(defects[0].node, NodeId(13));
  }
}

TEST(Validate, DefectsComeOrderedByKindAndIndex) {
  TetMesh mesh = box();
  mesh.nodes.emplace_back(5, 5, 5);
  mesh.nodes.emplace_back(6, 5, 5);
  for (const std::size_t t : {30u, 3u}) std::swap(mesh.tets[t][0], mesh.tets[t][1]);
  mesh.tets.push_back(tet_of(0, 0, 1, 2));
  const auto defects = find_defects(mesh);
  ASSERT_EQ(kinds(defects), (std::vector{DefectKind::inverted_tet, DefectKind::inverted_tet, DefectKind::repeated_node,
                                         DefectKind::unused_node, DefectKind::unused_node}));
  EXPECT_EQ(defects[0].tet, TetId(3));
  EXPECT_EQ(defects[1].tet, TetId(30));
  EXPECT_EQ(defects[3].node, NodeId(27));
}

TEST(OrientTets, TurnsOnlyInvertedTetsAndKeepsTheSurfacesInPlace) {
  TetMesh mesh = box();
  const TetMesh good = mesh;
  const auto area_of = [](const TetMesh& m, const char* set) {
    double area = 0.0;
    for (const TetFace face : m.find_face_set(set)->faces) area += face_area(m, face);
    return area;
  };
  // Inside out, with the face sets of the same triangles: the mirror image of what orient_tets does.
  for (std::size_t t = 0; t < mesh.tet_count(); t += 3) std::swap(mesh.tets[t][2], mesh.tets[t][3]);
  for (FaceSet& set : mesh.face_sets)
    for (TetFace& face : set.faces)
      if (face.tet.value() % 3 == 0 && face.vertex >= 2) face.vertex = static_cast<std::int8_t>(5 - face.vertex);

  EXPECT_EQ(orient_tets(mesh), 14u);  // 0, 3, ..., 39
  EXPECT_EQ(mesh.tets, good.tets);
  EXPECT_EQ(orient_tets(mesh), 0u);
  for (const char* set : {"-x", "+x", "-y", "+y", "-z", "+z"}) {
    EXPECT_EQ(mesh.find_face_set(set)->faces, good.find_face_set(set)->faces) << set;
    EXPECT_DOUBLE_EQ(area_of(mesh, set), 1.0) << set;
  }
}

}  // namespace
}  // namespace rhexis::mesh
