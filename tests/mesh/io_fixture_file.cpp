/// Files that Gmsh, VTK and h5py wrote (data/make_fixtures.py), in every encoding they know.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mesh/surface.h"
#include "tests/mesh/io_support.h"

namespace rhexis::mesh::test {
namespace {

std::filesystem::path data(const std::string& name) {
  return std::filesystem::path(RHEXIS_SOURCE_DIR) / "tests/mesh/data" / name;
}

MeshFile read_fixture(const std::string& name) {
  auto read = read_mesh_file(data(name));
  EXPECT_TRUE(read) << read.error().message();
  return read ? std::move(*read) : MeshFile{};
}

/// The text form, against which the others are held: 12 nodes, 18 tets, a box of 1 x 0.5 x 0.25.
const MeshFile& box() {
  static const MeshFile file = read_fixture("box_gmsh22.msh");
  return file;
}

TEST(IoFixture, BoxIsABox) {
  EXPECT_EQ(box().mesh.node_count(), 12U);
  EXPECT_EQ(box().mesh.tet_count(), 18U);
  EXPECT_NEAR(total_volume(box().mesh), 0.125, 1e-15);
  EXPECT_EQ(bounding_box(box().mesh).size(), Vec3(1.0, 0.5, 0.25));
}

class GmshFixture : public ::testing::TestWithParam<std::string> {};

TEST_P(GmshFixture, HasTheBodyAndItsSets) {
  const MeshFile file = read_fixture("box_" + GetParam() + ".msh");
  const TetMesh& mesh = file.mesh;
  EXPECT_EQ(mesh.nodes, box().mesh.nodes);
  EXPECT_EQ(mesh.tets, box().mesh.tets);
  EXPECT_THAT(file.notes, ::testing::IsEmpty());
  std::vector<std::string> names;
  for (const NodeSet& set : mesh.node_sets) names.push_back(set.name);
  EXPECT_THAT(names, ::testing::ElementsAre("corner", "edge", "top", "cap", "body", "all of it", "physical-2-11"));

  const auto expect_nodes = [&](const char* name, const auto& inside) {
    std::vector<NodeId> expected;
    for (std::size_t i = 0; i < mesh.node_count(); ++i) {
      if (inside(mesh.nodes[i])) expected.emplace_back(i);
    }
    ASSERT_NE(mesh.find_node_set(name), nullptr) << name;
    EXPECT_EQ(mesh.find_node_set(name)->nodes, expected) << name;
  };
  expect_nodes("corner", [](const Vec3& x) { return x.isZero(); });
  expect_nodes("edge", [](const Vec3& x) { return x[1] == 0.0 && x[2] == 0.0; });
  expect_nodes("top", [](const Vec3& x) { return x[2] == 0.25; });
  expect_nodes("cap", [](const Vec3& x) { return x[2] == 0.25; });
  expect_nodes("physical-2-11", [](const Vec3& x) { return x[2] == 0.0; });
  expect_nodes("body", [](const Vec3&) { return true; });
  expect_nodes("all of it", [](const Vec3&) { return true; });

  ASSERT_EQ(mesh.face_sets.size(), 3U);
  for (const FaceSet& set : mesh.face_sets) {
    double area = 0.0;
    for (const TetFace face : set.faces) area += face_area(mesh, face);
    EXPECT_NEAR(area, 0.5, 1e-15) << set.name;
    EXPECT_TRUE(std::is_sorted(set.faces.begin(), set.faces.end()));
  }
}

INSTANTIATE_TEST_SUITE_P(Encodings, GmshFixture,
                         ::testing::Values("gmsh22", "gmsh22_binary", "gmsh22_big_endian", "gmsh41", "gmsh41_binary",
                                           "gmsh41_big_endian"),
                         [](const auto& test) { return test.param; });

TEST(IoFixture, SecondOrderIsRefused) {
  const auto read = read_mesh_file(data("box_gmsh41_second_order.msh"));
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().line, 192);
  EXPECT_EQ(read.error().what, "element 11: second-order tetrahedra are not read");
  EXPECT_EQ(read.error().remedy, "mesh with elements of first order: gmsh -order 1");
}

class VtkFixture : public ::testing::TestWithParam<std::string> {};

TEST_P(VtkFixture, HasTheBodyAndItsFields) {
  const MeshFile file = read_fixture("box_" + GetParam());
  const TetMesh& mesh = file.mesh;
  // VTK prints text with fewer digits than a double has.
  ASSERT_EQ(mesh.node_count(), 12U);
  for (std::size_t i = 0; i < mesh.node_count(); ++i)
    EXPECT_NEAR((mesh.nodes[i] - box().mesh.nodes[i]).norm(), 0.0, 1e-6);
  EXPECT_EQ(mesh.tets, box().mesh.tets);
  EXPECT_THAT(file.notes, ::testing::ElementsAre("left out: 8 triangles (the body is made of linear tetrahedra)"));

  ASSERT_EQ(file.fields.size(), 4U);
  const auto field = [&](const std::string& name) -> const Field& {
    return *std::find_if(file.fields.begin(), file.fields.end(), [&](const Field& f) { return f.name == name; });
  };
  for (std::size_t i = 0; i < 12; ++i) {
    const Vec3& x = box().mesh.nodes[i];
    const double* u = field("displacement").values.data() + 3 * i;
    EXPECT_NEAR((Vec3(u[0], u[1], u[2]) - Vec3(x[0] + 2 * x[1], 3 * x[2], -x[0] * x[1] * x[2])).norm(), 0.0, 2e-6) << i;
    EXPECT_EQ(field("id").values[i], static_cast<double>(i));
  }
  EXPECT_EQ(field("displacement").centering, Centering::point);
  EXPECT_EQ(field("displacement").components, 3);
  EXPECT_EQ(field("stress").centering, Centering::cell);
  EXPECT_EQ(field("stress").components, 6);
  for (std::size_t i = 0; i < 18; ++i) {
    // Three tets, eight triangles, and the other tets.
    const auto cell = static_cast<double>(i < 3 ? i : i + 8);
    EXPECT_EQ(field("lambda").values[i], cell + 0.25);
    for (std::size_t c = 0; c < 6; ++c) EXPECT_EQ(field("stress").values[6 * i + c], 6 * cell + static_cast<double>(c));
  }
}

INSTANTIATE_TEST_SUITE_P(Encodings, VtkFixture,
                         ::testing::Values("vtk_ascii.vtu", "vtk_binary.vtu", "vtk_binary_wide.vtu",
                                           "vtk_binary_big_endian.vtu", "vtk_binary_zlib.vtu",
                                           "vtk_binary_zlib_wide.vtu", "vtk_binary_zlib_big_endian.vtu",
                                           "vtk_appended.vtu", "vtk_appended_wide.vtu", "vtk_appended_big_endian.vtu",
                                           "vtk_appended_base64.vtu", "vtk_appended_zlib.vtu",
                                           "vtk_appended_zlib_wide.vtu", "vtk_appended_zlib_big_endian.vtu",
                                           "vtk_appended_zlib_base64.vtu", "vtk42.vtk", "vtk42_binary.vtk", "vtk51.vtk",
                                           "vtk51_binary.vtk", "h5py.vtkhdf", "h5py_chunked.vtkhdf"),
                         [](const auto& test) { return with_underscores(test.param); });

}  // namespace
}  // namespace rhexis::mesh::test
