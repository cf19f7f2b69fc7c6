/// What is written reads back, bit for bit.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>

#include "tests/mesh/io_support.h"

namespace rhexis::mesh::test {
namespace {

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](double x, double y) {
    return std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y);
  });
}

void expect_same_body(const TetMesh& a, const TetMesh& b) {
  ASSERT_EQ(a.nodes.size(), b.nodes.size());
  for (std::size_t i = 0; i < a.nodes.size(); ++i) {
    EXPECT_TRUE(same_bits({a.nodes[i].begin(), a.nodes[i].end()}, {b.nodes[i].begin(), b.nodes[i].end()}))
        << "node " << i;
  }
  EXPECT_EQ(a.tets, b.tets);
}

class IoRoundTrip : public ::testing::TestWithParam<std::string> {};

TEST_P(IoRoundTrip, KeepsEveryBit) {
  const TemporaryFolder folder;
  const TetMesh mesh = awkward_bar(50);
  const std::vector<Field> fields = awkward_fields(mesh);
  const auto path = folder / ("bar" + GetParam());
  const auto written = write_mesh_file(path, mesh, fields);
  ASSERT_TRUE(written) << written.error().message();
  const auto read = read_mesh_file(path);
  ASSERT_TRUE(read) << read.error().message();
  expect_same_body(mesh, read->mesh);
  // The spare node is the one thing to be said about this mesh.
  ASSERT_EQ(read->notes.size(), 1U);
  EXPECT_EQ(read->notes[0], "1 nodes belong to no tet (the first is 204): kept, as nodes that do not move");
  if (GetParam().starts_with(".msh")) {
    EXPECT_TRUE(read->fields.empty());
    ASSERT_EQ(read->mesh.node_sets.size(), mesh.node_sets.size());
    for (std::size_t i = 0; i < mesh.node_sets.size(); ++i) {
      EXPECT_EQ(read->mesh.node_sets[i].name, mesh.node_sets[i].name);
      EXPECT_EQ(read->mesh.node_sets[i].nodes, mesh.node_sets[i].nodes);
    }
    ASSERT_EQ(read->mesh.face_sets.size(), 1U);
    EXPECT_EQ(read->mesh.face_sets[0].name, "-x");
    EXPECT_EQ(read->mesh.face_sets[0].faces, mesh.face_sets[0].faces);
    EXPECT_EQ(mesh.face_sets[0].faces.size(), 2U);
    return;
  }
  // Files keep point fields before cell fields, each in the order given.
  ASSERT_EQ(read->fields.size(), fields.size());
  for (const Field& field : fields) {
    const auto at = std::find_if(read->fields.begin(), read->fields.end(), [&](const Field& f) {
      return f.name == field.name && f.centering == field.centering;
    });
    ASSERT_NE(at, read->fields.end()) << field.name;
    EXPECT_EQ(at->components, field.components);
    EXPECT_TRUE(same_bits(at->values, field.values)) << field.name;
  }
  std::vector<std::string> names;
  for (const Field& field : read->fields) names.push_back(field.name);
  EXPECT_THAT(names, ::testing::ElementsAre("u <&\"> v", "lambda", "lambda", "stress"));
}

TEST_P(IoRoundTrip, SameMeshSameBytes) {
  const TemporaryFolder folder;
  const TetMesh mesh = awkward_bar(3);
  for (const char* name : {"one", "two"})
    ASSERT_TRUE(write_mesh_file(folder / (name + GetParam()), mesh, awkward_fields(mesh)));
  const std::string one = read_bytes(folder / ("one" + GetParam()));
  EXPECT_GT(one.size(), 100U);
  EXPECT_EQ(one, read_bytes(folder / ("two" + GetParam())));
}

INSTANTIATE_TEST_SUITE_P(Formats, IoRoundTrip,
                         ::testing::Values(".msh", ".msh.gz", ".vtu", ".vtu.gz", ".vtkhdf", ".vtkhdf.gz"),
                         [](const auto& test) { return with_underscores(test.param.substr(1)); });

TEST(IoWrite, UnitIsAppliedToCoordinatesAlone) {
  const TemporaryFolder folder;
  const TetMesh mesh = awkward_bar(1);
  ASSERT_TRUE(write_mesh_file(folder / "bar.vtu", mesh, awkward_fields(mesh)));
  const auto read = read_mesh_file(folder / "bar.vtu", {.unit = 1e-3});
  ASSERT_TRUE(read);
  EXPECT_EQ(read->mesh.nodes[4], Vec3(mesh.nodes[4] * 1e-3));
  EXPECT_TRUE(same_bits(read->fields[0].values, awkward_fields(mesh)[0].values));
}

TEST(IoWrite, TurnedTetsAreTurnedBackAndSaid) {
  const TemporaryFolder folder;
  TetMesh mesh = awkward_bar(2);
  mesh.node_sets.clear();
  std::swap(mesh.tets[3][0], mesh.tets[3][1]);
  std::swap(mesh.tets[7][2], mesh.tets[7][3]);
  for (const char* name : {"turned.vtu", "turned.vtkhdf", "turned.msh"}) {
    ASSERT_TRUE(write_mesh_file(folder / name, mesh));
    const auto read = read_mesh_file(folder / name);
    ASSERT_TRUE(read);
    ASSERT_FALSE(read->notes.empty());
    EXPECT_EQ(read->notes[0], "2 of 12 tets were inside out: two nodes of each swapped");
    for (std::size_t i = 0; i < read->mesh.tets.size(); ++i) EXPECT_GT(signed_volume(read->mesh, TetId(i)), 0.0) << i;
  }
}

TEST(IoWrite, FieldsThatDoNotFitAreRefused) {
  const TemporaryFolder folder;
  const TetMesh mesh = awkward_bar(1);  // 9 nodes, 6 tets
  const auto message = [&](const Field& field, const char* file = "out.vtu") {
    const auto written = write_mesh_file(folder / file, mesh, {field});
    EXPECT_FALSE(std::filesystem::exists(folder / file));
    return written ? "" : written.error().message().substr((folder / "").string().size());
  };
  EXPECT_EQ(message({"u", Centering::point, 3, std::vector<double>(26)}),
            "out.vtu: field 'u' holds 26 values, 9 nodes with 3 components need 27");
  EXPECT_EQ(message({"s", Centering::cell, 1, std::vector<double>(9)}),
            "out.vtu: field 's' holds 9 values, 6 tets with 1 components need 6");
  EXPECT_EQ(message({"a/b", Centering::cell, 1, std::vector<double>(6)}),
            "out.vtu: field 'a/b' has a name that files cannot hold");
  EXPECT_EQ(message({"", Centering::cell, 1, std::vector<double>(6)}),
            "out.vtu: field '' has a name that files cannot hold");
  EXPECT_EQ(message({"s", Centering::cell, 0, {}}), "out.vtu: field 's' has 0 components");
  EXPECT_EQ(
      message({"s", Centering::cell, 1, std::vector<double>(6)}, "out.stl"),
      "out.stl: a mesh cannot be written with the ending '.stl' (.vtkhdf, .vtu or .msh, each also with .gz behind)");
  EXPECT_EQ(
      message({"s", Centering::cell, 1, std::vector<double>(6)}, "out.vtk"),
      "out.vtk: a mesh cannot be written with the ending '.vtk' (.vtkhdf, .vtu or .msh, each also with .gz behind)");
  const Field twice{"s", Centering::cell, 1, std::vector<double>(6)};
  const auto written = write_mesh_file(folder / "out.vtu", mesh, {twice, twice});
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().what, "field 's' is there twice");
}

TEST(IoWrite, FolderThatIsAFileIsRefused) {
  const TemporaryFolder folder;
  write_bytes(folder / "file", "x");
  for (const char* name : {"file/out.vtu", "file/out.vtkhdf", "file/out.msh"}) {
    EXPECT_FALSE(write_mesh_file(folder / name, awkward_bar(1))) << name;
  }
  EXPECT_EQ(read_bytes(folder / "file"), "x");
}

TEST(IoWrite, Series) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write_series(folder / "steps.pvd", {{0.1, "steps/a&b.vtu"}, {1.0, "steps/2.vtu"}}));
  EXPECT_EQ(read_bytes(folder / "steps.pvd"),
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" "
            "byte_order=\"LittleEndian\">\n<Collection>\n"
            "<DataSet timestep=\"0.1\" part=\"0\" file=\"steps/a&amp;b.vtu\"/>\n"
            "<DataSet timestep=\"1\" part=\"0\" file=\"steps/2.vtu\"/>\n</Collection>\n</VTKFile>\n");
}

}  // namespace
}  // namespace rhexis::mesh::test
