#include "mesh/quality.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>

#include <Eigen/Dense>
#include <nlohmann/json.hpp>

#include "base/clock.h"
#include "mesh/generate.h"
#include "mesh/io/mesh_file.h"
#include "tests/support/shared_data.h"

namespace rhexis::mesh {
namespace {

const std::array<Vec3, 4> kRegular{Vec3(1, 1, 1), Vec3(-1, 1, -1), Vec3(1, -1, -1), Vec3(-1, -1, 1)};
const std::array<Vec3, 4> kCorner{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)};

TetMesh one_tet(const std::array<Vec3, 4>& x) {
  TetMesh mesh;
  mesh.nodes.assign(x.begin(), x.end());
  mesh.tets = {{NodeId(0), NodeId(1), NodeId(2), NodeId(3)}};
  return mesh;
}

TEST(RadiusRatio, OfKnownTets) {
  EXPECT_NEAR(radius_ratio(kRegular), 1.0, 1e-15);
  // Corner of a cube: r_in = 1 / (3 + sqrt 3), r_circ = sqrt 3 / 2.
  const double corner = 3.0 / (3.0 + std::sqrt(3.0)) * 2.0 / std::sqrt(3.0);
  EXPECT_NEAR(radius_ratio(kCorner), corner, 1e-15);
}

TEST(RadiusRatio, DoesNotDependOnSizePlaceOrOrder) {
  const double expected = radius_ratio(kCorner);
  std::array<Vec3, 4> moved = kCorner;
  for (Vec3& x : moved) x = 1e-3 * (x + Vec3(3, -2, 1));
  EXPECT_NEAR(radius_ratio(moved), expected, 1e-13);  // the shift costs a few digits
  EXPECT_NEAR(radius_ratio({kCorner[2], kCorner[1], kCorner[0], kCorner[3]}), expected, 1e-15);
}

TEST(RadiusRatio, OfCornersThatHaveComeTogetherIsZero) {
  // Two nodes brought to one point, up to rounding: not a regular tet of no size.
  const Vec3 a(1.0 / 120.0, 1.0 / 120.0, 0.15);
  const Vec3 b(0.0, 0.0, 2.4 / 17.0);
  const Vec3 c(0.0, 1.0 / 60.0, 2.5 / 17.0);
  for (const double apart : {0.0, 1e-18, 3e-17, 1e-16}) {
    EXPECT_LT(radius_ratio({a, b, c, c + apart * Vec3(1.0, 2.0, -1.0)}), 1e-10);
    EXPECT_LT(radius_ratio({c + apart * Vec3(1.0, 2.0, -1.0), b, c, a}), 1e-10);
  }
}

TEST(RadiusRatio, OfFlatTetsIsZero) {
  std::array<Vec3, 4> flat = kCorner;
  flat[3] = Vec3(0.3, 0.3, 0.0);
  EXPECT_EQ(radius_ratio(flat), 0.0);
  flat.fill(Vec3(1, 1, 1));
  EXPECT_EQ(radius_ratio(flat), 0.0);
}

TEST(Quality, OfTheRegularTet) {
  const Quality quality = measure_quality(one_tet(kRegular));
  const double angle = std::acos(1.0 / 3.0) * 180.0 / std::numbers::pi;
  EXPECT_NEAR(quality.dihedral.min, angle, 1e-13);
  EXPECT_NEAR(quality.dihedral.max, angle, 1e-13);
  EXPECT_NEAR(quality.edge.mean, std::sqrt(8.0), 1e-15);
  EXPECT_NEAR(quality.volume.mean, 8.0 / 3.0, 1e-15);
}

TEST(Quality, OfTheCornerOfACube) {
  const Quality quality = measure_quality(one_tet(kCorner));
  const double slope = std::atan(std::sqrt(2.0)) * 180.0 / std::numbers::pi;  // between a side and the slanted face
  EXPECT_NEAR(quality.dihedral.min, slope, 1e-13);
  EXPECT_NEAR(quality.dihedral.max, 90.0, 1e-13);
  EXPECT_NEAR(quality.dihedral.mean, 0.5 * (90.0 + slope), 1e-13);
  EXPECT_NEAR(quality.edge.mean, 0.5 * (1.0 + std::sqrt(2.0)), 1e-15);
}

TEST(Quality, CountsAnEdgeOnce) {
  // Five tets: 12 cell edges of length 1 and 6 face diagonals.
  const Quality quality = measure_quality(make_structured_box({1, 1, 1}, {1, 1, 1}));
  EXPECT_NEAR(quality.edge.mean, (12.0 + 6.0 * std::sqrt(2.0)) / 18.0, 1e-15);
  EXPECT_NEAR(quality.volume.mean, 0.2, 1e-16);
}

TEST(Quality, OfNothingIsZero) {
  const Quality quality = measure_quality(TetMesh{});
  EXPECT_EQ(quality.edge.max, 0.0);
  EXPECT_EQ(quality.dihedral.min, 0.0);
}

/// The other program took the mean over the six edges of each tet, inner edges several times.
double edge_mean_over_tets(const TetMesh& mesh) {
  double sum = 0.0;
  for (std::size_t t = 0; t < mesh.tet_count(); ++t) {
    const auto x = corners(mesh, TetId(t));
    for (const auto& [i, j] : kTetEdges)
      sum += (x[static_cast<std::size_t>(i)] - x[static_cast<std::size_t>(j)]).norm();
  }
  return sum / (6.0 * static_cast<double>(mesh.tet_count()));
}

class QualityOfSharedMeshes : public testing::TestWithParam<const char*> {};

TEST_P(QualityOfSharedMeshes, AgreesWithAnotherProgram) {
  const std::string name = GetParam();
  auto file = test::shared_dir() / "data" / (name + ".msh");
  if (!std::filesystem::exists(file)) file += ".gz";
  const auto figures_file = test::shared_dir() / "data" / (name + ".json");
  RHEXIS_SKIP_WITHOUT(figures_file);
  const auto figures = nlohmann::json::parse(std::ifstream(figures_file));
  const auto read = read_mesh_file(file);
  ASSERT_TRUE(read.has_value()) << read.error().message();
  const TetMesh& mesh = read->mesh;
  const Quality quality = measure_quality(mesh);

  // The file holds 8 significant digits of coordinates up to 0.4 m, the figures were made with all: corners are off by
  // up to 5e-9 m, and the figures by that over the shortest edge, times a small number for the shape of the tet.
  const double tolerance = 10.0 * 5e-9 / figures.at("edge_min").get<double>();
  const auto expect = [&](double value, const char* figure) {
    const double expected = figures.at(figure);
    EXPECT_NEAR(value, expected, tolerance * std::abs(expected)) << name << " " << figure;
  };
  EXPECT_EQ(mesh.node_count(), figures.at("nodes").get<std::size_t>());
  EXPECT_EQ(mesh.tet_count(), figures.at("tets").get<std::size_t>());
  expect(total_volume(mesh), "volume");
  expect(quality.volume.min, "vmin");
  expect(quality.dihedral.min, "dih_min");
  expect(quality.dihedral.max, "dih_max");
  expect(quality.radius_ratio.min, "radratio_min");
  expect(quality.radius_ratio.mean, "radratio_mean");
  expect(quality.edge.min, "edge_min");
  expect(edge_mean_over_tets(mesh), "edge_mean");
  expect(quality.edge.max, "edge_max");
}

INSTANTIATE_TEST_SUITE_P(Files, QualityOfSharedMeshes,
                         testing::Values("kidney_1k", "liver_1k", "plate_506", "plate_1012_slit", "vessel_solid_401",
                                         "veins_solid_3k", "vessel_wall_30k"));

TEST(Thickness, OfABoxIsItsSmallestSide) {
  EXPECT_NEAR(thickness(make_bar({Vec3(0.1, 0.1, 0.4)}, 425).value()), 0.1, 1e-15);
  EXPECT_NEAR(thickness(make_bar({Vec3(0.3, 0.2, 0.25)}, 425).value()), 0.2, 1e-15);
  EXPECT_NEAR(thickness(make_bar({Vec3(1, 1, 1)}, 1000).value()), 1.0, 1e-15);
  EXPECT_NEAR(thickness(make_structured_box({3, 4, 5}, {1, 1, 1})), 3.0, 1e-15);
}

TEST(Thickness, OfAPlateIsItsHeightAlthoughItHasNoNodesInside) {
  EXPECT_NEAR(thickness(make_plate({Vec3(0.24, 0.24, 0.01)}, 506).value()), 0.01, 1e-16);
  EXPECT_NEAR(thickness(make_plate({Vec3(0.24, 0.24, 0.01)}, 5000).value()), 0.01, 1e-16);
}

TEST(Thickness, OfARodIsItsDiameterLessTheFaceting) {
  const double diameter = thickness(make_tube({.radius = 0.005, .length = 0.04}, 3000).value());
  EXPECT_LT(diameter, 0.01);
  EXPECT_GT(diameter, 0.0098);
  EXPECT_NEAR(thickness(make_tube({.radius = 0.005, .length = 0.04, .bend = 90.0}, 3000).value()), 0.01, 2e-4);
}

TEST(Thickness, OfATubeIsItsWall) {
  EXPECT_NEAR(thickness(make_tube({.wall = 0.0015}, 3000).value()), 0.0015, 0.02 * 0.0015);
  EXPECT_NEAR(thickness(make_tube({.wall = 0.0015, .bend = -60.0}, 30000).value()), 0.0015, 0.01 * 0.0015);
}

TEST(Thickness, OfARealVesselWallIsTheOffsetItWasMadeWith) {
  const auto file = test::shared_dir() / "data" / "vessel_wall_30k.msh.gz";
  RHEXIS_SKIP_WITHOUT(file);
  const TetMesh mesh = read_mesh_file(file).value().mesh;
  const Stopwatch watch;
  // The wall was made by a 1.5 mm offset of a voxel surface with 0.3 mm voxels, and cut across at five ends.
  EXPECT_NEAR(thickness(mesh), 1.5e-3, 0.1e-3);
  EXPECT_LT(watch.seconds(), 2.0);  // measured: 0.2 s
}

TEST(Thickness, ASlitIsASurface) {
  // Two plates on top of each other, the nodes between them doubled: coincident faces, but not connected.
  TetMesh two = make_structured_box({1, 1, 0.1}, {10, 10, 1});
  const TetMesh lower = two;
  for (const Vec3& x : lower.nodes) two.nodes.push_back(x + Vec3(0, 0, 0.1));
  const int shift = static_cast<int>(lower.node_count());
  for (const Tet& t : lower.tets)
    two.tets.push_back({NodeId(t[0].value() + shift), NodeId(t[1].value() + shift), NodeId(t[2].value() + shift),
                        NodeId(t[3].value() + shift)});
  EXPECT_NEAR(thickness(two), 0.1, 1e-15);
}

TEST(Thickness, EndsOnAMeshThatIsTangled) {
  TetMesh mesh = make_bar({Vec3(1, 1, 1)}, 20000).value();
  for (std::size_t i = 0; i < mesh.node_count(); i += 2) mesh.nodes[i] = mesh.nodes[(7919 * i) % mesh.node_count()];
  const Stopwatch watch;
  EXPECT_GE(thickness(mesh), 0.0);
  EXPECT_LT(watch.seconds(), 10.0);  // measured: 1.2 s; the limit is 100 steps a tet
}

TEST(Thickness, OfNothingIsZero) { EXPECT_EQ(thickness(TetMesh{}), 0.0); }

}  // namespace
}  // namespace rhexis::mesh
