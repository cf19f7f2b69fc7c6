/// Real meshes, read in the formats they come in.

#include <gtest/gtest.h>

#include <fstream>
#include <regex>

#include "mesh/surface.h"
#include "tests/mesh/io_support.h"
#include "tests/support/shared_data.h"

namespace rhexis::mesh::test {
namespace {

/// The few entries of the .json beside a mesh that matter here.
struct Expected {
  std::size_t nodes = 0;
  std::size_t tets = 0;
  double volume = 0.0;
  std::vector<std::pair<std::string, std::size_t>> surfaces;  ///< name and number of triangles
};

Expected read_json(const std::filesystem::path& path) {
  const std::string text = read_bytes(path);
  const auto number = [&](const std::string& key) {
    std::smatch found;
    EXPECT_TRUE(std::regex_search(text, found, std::regex("\"" + key + "\": ([-+0-9.e]+)"))) << key;
    return std::stod(found[1]);
  };
  Expected expected{
      static_cast<std::size_t>(number("nodes")), static_cast<std::size_t>(number("tets")), number("volume"), {}};
  const std::regex tag("\"\\d+\": \\[\\s*\"(\\w+)\",\\s*(\\d+)\\s*\\]");
  for (std::sregex_iterator at(text.begin(), text.end(), tag), end; at != end; ++at) {
    expected.surfaces.emplace_back((*at)[1], std::stoul((*at)[2]));
  }
  return expected;
}

class IoShared : public ::testing::TestWithParam<std::string> {};

TEST_P(IoShared, HoldsWhatIsSaidOfIt) {
  const auto path = rhexis::test::shared_dir() / "data" / GetParam();
  RHEXIS_SKIP_WITHOUT(path);
  const auto read = read_mesh_file(path);
  ASSERT_TRUE(read) << read.error().message();
  const Expected expected =
      read_json(rhexis::test::shared_dir() / "data" / (GetParam().substr(0, GetParam().find('.')) + ".json"));
  const TetMesh& mesh = read->mesh;
  EXPECT_TRUE(read->notes.empty()) << read->notes.front();
  EXPECT_EQ(mesh.node_count(), expected.nodes);
  EXPECT_EQ(mesh.tet_count(), expected.tets);
  // The volume was taken before coordinates were rounded to the 8 digits of the file.
  EXPECT_NEAR(total_volume(mesh), expected.volume, 1e-7 * expected.volume);
  if (path.extension() == ".vtu") return;
  ASSERT_FALSE(expected.surfaces.empty());
  ASSERT_EQ(mesh.face_sets.size(), expected.surfaces.size());
  for (const auto& [name, triangles] : expected.surfaces) {
    ASSERT_NE(mesh.find_face_set(name), nullptr) << name;
    EXPECT_EQ(mesh.find_face_set(name)->faces.size(), triangles) << name;
    std::vector<NodeId> nodes;
    for (const TetFace face : mesh.find_face_set(name)->faces) {
      for (const NodeId node : face_nodes(mesh, face)) nodes.push_back(node);
    }
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    EXPECT_EQ(mesh.find_node_set(name)->nodes, nodes) << name;
  }
  EXPECT_EQ(mesh.find_node_set("body")->nodes.size(), mesh.node_count());
}

INSTANTIATE_TEST_SUITE_P(Meshes, IoShared,
                         ::testing::Values("vessel_solid_401.msh", "vessel_solid_401.vtu", "plate_506_slit.msh",
                                           "plate_506_slit.vtu", "plate_1270.msh", "liver_1k.msh", "kidney_1k.vtu",
                                           "vessel_wall_30k.msh.gz", "plate_20000_slit.msh.gz"),
                         [](const auto& test) { return with_underscores(test.param); });

}  // namespace
}  // namespace rhexis::mesh::test
