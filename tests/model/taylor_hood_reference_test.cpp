/// Against solutions of the same problem by DOLFINx, P2/P1 with the same law: the bar of shared/reference/2_bar,
/// clamped at z = 0 and bent by its weight to two thirds of its length.

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "mesh/io/mesh_file.h"
#include "model/taylor_hood.h"
#include "tests/model/small_newton.h"
#include "tests/model/test_bodies.h"
#include "tests/support/shared_data.h"

namespace rhexis::model {
namespace {

/// Numbers of a CSV file with one line of heading, row by row.
std::vector<double> read_csv(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  std::vector<double> values;
  while (std::getline(file, line)) {
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) values.push_back(std::stod(cell));
  }
  return values;
}

/// How far from the reference the result may be, relative to the largest displacement and lambda. The reference was
/// integrated by another rule, so that agreement ends at the quadrature error, which falls with h: 8.5e-5 and 1.5e-4 on
/// kuhn1, one cell thick, 9.7e-6 and 6.6e-5 on kuhn2. (A product rule of 512 points comes no closer than 5.8e-5 on
/// kuhn1.) The mesh's own error there is 6% and 2%.
struct Bar {
  std::string name;
  double u_tolerance;
  double lambda_tolerance;
};

class TaylorHoodReference : public testing::TestWithParam<Bar> {};
INSTANTIATE_TEST_SUITE_P(, TaylorHoodReference, testing::Values(Bar{"kuhn1", 2e-4, 3e-4}, Bar{"kuhn2", 2e-5, 1.5e-4}),
                         [](const auto& p) { return p.param.name; });

TEST_P(TaylorHoodReference, BarUnderItsWeight) {
  const std::filesystem::path folder = test::shared_dir() / "reference" / "2_bar";
  RHEXIS_SKIP_WITHOUT(folder);
  const auto file = mesh::read_mesh_file(folder / (GetParam().name + ".msh"));
  ASSERT_TRUE(file) << file.error().message();
  const mesh::TetMesh& mesh = file->mesh;
  ModelSettings settings;
  settings.law = {8389.261744966443, 8389.261744966443, 1666666.666666665};
  const auto model = make_taylor_hood(mesh, settings);

  Loading loading;
  for (const std::int32_t node : nodes_of_set(model->space(), test::nodes_on_plane(mesh, 2, 0.0))) {
    for (std::int32_t k = 3 * node; k < 3 * node + 3; ++k) loading.supports.push_back({k, 0.0});
  }
  loading.dead_force.setZero(static_cast<Eigen::Index>(model->space().dof_count()));
  add_body_force(mesh, model->space(), Vec3(0.0, -9.81 * 1000.0, 0.0), loading.dead_force);

  State state = model->initial_state();
  for (const double t : {0.2, 0.4, 0.6, 0.8, 1.0}) {
    ASSERT_GE(test::solve_small(*model, loading, t, 1e-11, state), 0) << "at load " << t;
  }
  const std::vector<double> u = read_csv(folder / (GetParam().name + "_T_u.csv"));
  const std::vector<double> lambda = read_csv(folder / (GetParam().name + "_T_pvertex.csv"));
  ASSERT_EQ(u.size(), 3 * mesh.node_count());
  ASSERT_EQ(lambda.size(), mesh.node_count());
  const Eigen::Map<const VectorX> expected_u(u.data(), static_cast<Eigen::Index>(u.size()));
  const Eigen::Map<const VectorX> expected_lambda(lambda.data(), static_cast<Eigen::Index>(lambda.size()));
  const VectorX vertex_u = state.u.head(expected_u.size());
  EXPECT_LT((vertex_u - expected_u).cwiseAbs().maxCoeff(), GetParam().u_tolerance * expected_u.cwiseAbs().maxCoeff());
  EXPECT_LT((state.lambda - expected_lambda).cwiseAbs().maxCoeff(),
            GetParam().lambda_tolerance * expected_lambda.cwiseAbs().maxCoeff());
}

}  // namespace
}  // namespace rhexis::model
