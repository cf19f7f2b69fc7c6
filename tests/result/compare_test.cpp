#include "result/compare.h"

#include <gtest/gtest.h>

#include "mesh/generate.h"
#include "mesh/io/mesh_file.h"
#include "tests/support/run_command.h"

namespace rhexis {
namespace {

namespace fs = std::filesystem;

mesh::TetMesh box() { return mesh::make_structured_box(Vec3(1.0, 2.0, 4.0), {1, 1, 1}); }

mesh::Field displacement(const mesh::TetMesh& mesh, const Vec3& u, double extra_at_3 = 0.0) {
  mesh::Field field{"displacement", mesh::Centering::point, 3, {}};
  for (std::size_t n = 0; n < mesh.node_count(); ++n)
    for (int i = 0; i < 3; ++i) field.values.push_back(u[i] + (n == 3 && i == 1 ? extra_at_3 : 0.0));
  return field;
}

TEST(Compare, MeasuresLargestMeanAndThePercentOfTheBox) {
  const fs::path folder = test::fresh_folder("compare");
  const mesh::TetMesh mesh = box();
  ASSERT_TRUE(mesh::write_mesh_file(folder / "a.vtu", mesh, {displacement(mesh, Vec3(3, 0, 4))}));
  ASSERT_TRUE(mesh::write_mesh_file(folder / "b.vtkhdf", mesh,
                                    {displacement(mesh, Vec3(3, 0, 4), 0.5),
                                     {"J", mesh::Centering::cell, 1, std::vector<double>(mesh.tet_count(), 1.0)}}));
  const Expected<result::Comparison> comparison = result::compare_results(folder / "a.vtu", folder / "b.vtkhdf");
  ASSERT_TRUE(comparison) << comparison.error().message();
  ASSERT_EQ(comparison->fields.size(), 1u);
  const result::FieldDifference& d = comparison->fields[0];
  EXPECT_DOUBLE_EQ(d.largest, 0.5);
  EXPECT_EQ(d.largest_at, 3u);
  EXPECT_DOUBLE_EQ(d.mean, 0.5 / 8);
  EXPECT_DOUBLE_EQ(d.scale, 5.0);
  EXPECT_DOUBLE_EQ(d.relative_largest(), 0.1);
  EXPECT_DOUBLE_EQ(comparison->displacement.largest.y(), 25.0);  // 0.5 of a side of 2
  EXPECT_DOUBLE_EQ(comparison->displacement.largest.x(), 0.0);
  EXPECT_EQ(comparison->only_in_one, std::vector<std::string>{"J"});
}

TEST(Compare, NamesTheFirstNodeAndTetThatDiffer) {
  const fs::path folder = test::fresh_folder("other");
  const mesh::TetMesh mesh = box();
  mesh::TetMesh moved = mesh;
  moved.nodes[5].x() += 0.1;
  mesh::TetMesh turned = mesh;
  std::rotate(turned.tets[2].begin(), turned.tets[2].begin() + 1, turned.tets[2].begin() + 3);
  const auto u = [](const mesh::TetMesh& of) { return std::vector<mesh::Field>{displacement(of, Vec3::Zero())}; };
  ASSERT_TRUE(mesh::write_mesh_file(folder / "a.vtu", mesh, u(mesh)));
  ASSERT_TRUE(mesh::write_mesh_file(folder / "moved.vtu", moved, u(moved)));
  ASSERT_TRUE(mesh::write_mesh_file(folder / "turned.vtu", turned, u(turned)));
  EXPECT_NE(result::compare_results(folder / "a.vtu", folder / "moved.vtu").error().what.find("node 5"),
            std::string::npos);
  EXPECT_NE(result::compare_results(folder / "a.vtu", folder / "turned.vtu").error().what.find("tet 2"),
            std::string::npos);
}

}  // namespace
}  // namespace rhexis
