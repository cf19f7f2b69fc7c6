// Equilibria against DOLFINx and CalculiX: displacement and lambda to 1e-7 of the largest value.

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "material/parameters.h"
#include "model/make_model.h"
#include "solver/equilibrium.h"
#include "tests/support/measured.h"
#include "tests/support/reference.h"
#include "tests/support/shared_data.h"

namespace rhexis {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// What the issue asks for; the reference files carry 16 digits and residuals below 1e-11.
constexpr double kAgreement = 1e-7;

struct Case {
  std::string name;    ///< for the test's name
  std::string folder;  ///< under the reference folder
  std::string mesh;    ///< stem of the mesh files
  std::string model;   ///< L, C, G, PSH
  double beta = 0.0;
  double density = 0.0;
  bool matched = false;  ///< L, C, G with the constants that match c1, c2, kappa
  std::string solution;  ///< stem of the solution files
  int steps = 1;
};

std::ostream& operator<<(std::ostream& out, const Case& c) { return out << c.name; }

model::ModelSettings settings_of(const Case& c, const json& p) {
  model::ModelSettings settings;
  settings.elastic = {p["E"], p["nu"]};
  settings.law = {p["c1"], p["c2"], p["kappa"]};
  if (c.matched) settings.elastic = material::to_elastic(settings.law);
  settings.beta = c.beta;
  static const std::map<std::string, model::ModelKind> kinds{{"L", model::ModelKind::linear},
                                                             {"C", model::ModelKind::corotated},
                                                             {"G", model::ModelKind::geometrically_nonlinear},
                                                             {"PSH", model::ModelKind::hyperelastic}};
  settings.kind = kinds.at(c.model);
  return settings;
}

void hold(model::Loading& loading, const mesh::TetMesh& mesh, const std::string& set, int component, double value) {
  for (const NodeId node : mesh.find_node_set(set)->nodes)
    loading.supports.push_back({3 * node.value() + component, value});
}

void sort_supports(model::Loading& loading) {
  std::sort(loading.supports.begin(), loading.supports.end(),
            [](const auto& a, const auto& b) { return a.dof < b.dof; });
}

solver::Report solve(const model::Model& body, const model::Loading& loading, const Case& c, model::State& state) {
  solver::Options options;
  options.tolerance = 1e-12;
  options.steps = c.steps;
  state = body.initial_state();
  return solver::solve_equilibrium(body, loading, options, state);
}

double largest_difference(const VectorX& ours, const std::vector<double>& theirs) {
  const Eigen::Map<const VectorX> reference(theirs.data(), static_cast<Eigen::Index>(theirs.size()));
  EXPECT_EQ(ours.size(), reference.size());
  return (ours - reference).cwiseAbs().maxCoeff() / reference.cwiseAbs().maxCoeff();
}

class Reference : public testing::TestWithParam<Case> {
 protected:
  void compare(const model::Loading& loading, const mesh::TetMesh& mesh, const model::ModelSettings& settings,
               const std::vector<double>& u, const std::vector<double>& lambda) {
    const Case& c = GetParam();
    const std::unique_ptr<model::Model> body = model::make_model(mesh, settings);
    model::State state;
    const solver::Report report = solve(*body, loading, c, state);
    ASSERT_TRUE(report.converged()) << report.why;
    const double apart_u = largest_difference(state.u, u);
    EXPECT_LT(apart_u, kAgreement);
    const double apart_lambda = lambda.empty() ? 0.0 : largest_difference(state.lambda, lambda);
    EXPECT_LT(apart_lambda, kAgreement);
    test::measured("{}/{}: u {:.1e}, lambda {:.1e}", c.folder, c.name, apart_u, apart_lambda);
    // Every equilibrium of the reference is stable.
    if (report.negative_pivots) {
      EXPECT_EQ(*report.negative_pivots, 0);
    }
  }
};

class Patch : public Reference {};
TEST_P(Patch, AgreesWithOtherPrograms) {
  const Case& c = GetParam();
  const fs::path folder = test::shared_dir() / "reference" / c.folder;
  RHEXIS_SKIP_WITHOUT(folder);
  const mesh::TetMesh mesh = test::read_reference_mesh(folder / c.mesh);
  const json solution = test::read_json(folder / (c.solution + ".json"));
  std::vector<double> u;
  for (const auto& row : solution["u"]) u.insert(u.end(), row.begin(), row.end());
  model::Loading loading;
  loading.dead_force = VectorX::Zero(static_cast<Eigen::Index>(3 * mesh.node_count()));
  const std::vector<std::string> held = c.solution.find("clamp_pull") != std::string::npos
                                            ? std::vector<std::string>{"z0", "z1"}
                                            : std::vector<std::string>{"boundary"};
  for (const std::string& set : held)
    for (const NodeId node : mesh.find_node_set(set)->nodes)
      for (int i = 0; i < 3; ++i)
        loading.supports.push_back({3 * node.value() + i, u[3 * node.index() + static_cast<std::size_t>(i)]});
  sort_supports(loading);
  const std::vector<double> lambda =
      c.model == "PSH" ? solution["lambda"].get<std::vector<double>>() : std::vector<double>{};
  compare(loading, mesh, settings_of(c, test::read_json(folder / "parameters.json")["parameters"]), u, lambda);
}

/// A body under its weight at c.density, held as `hold_sets` says.
class Weighted : public Reference {
 protected:
  template <class HoldSets>
  void compare_under_weight(const HoldSets& hold_sets) {
    const Case& c = GetParam();
    const fs::path folder = test::shared_dir() / "reference" / c.folder;
    RHEXIS_SKIP_WITHOUT(folder / (c.solution + "_u.csv"));
    const mesh::TetMesh mesh = test::read_reference_mesh(folder / c.mesh);
    const json parameters = test::read_json(folder / "parameters.json");
    model::Loading loading;
    loading.dead_force = VectorX::Zero(static_cast<Eigen::Index>(3 * mesh.node_count()));
    const std::vector<double> g = parameters["g"];
    model::add_body_force(mesh, model::make_p1_space(mesh), c.density * Vec3(g[0], g[1], g[2]), loading.dead_force);
    hold_sets(loading, mesh);
    sort_supports(loading);
    compare(loading, mesh, settings_of(c, parameters), test::read_csv(folder / (c.solution + "_u.csv")),
            c.model == "PSH" ? test::read_csv(folder / (c.solution + "_lambda.csv")) : std::vector<double>{});
  }
};

class Bar : public Weighted {};
TEST_P(Bar, AgreesWithOtherPrograms) {
  compare_under_weight([](model::Loading& loading, const mesh::TetMesh& mesh) {
    for (int i = 0; i < 3; ++i) hold(loading, mesh, "z0", i, 0.0);
  });
}

class Vessel : public Weighted {};
TEST_P(Vessel, AgreesWithOtherPrograms) {
  compare_under_weight([](model::Loading& loading, const mesh::TetMesh& mesh) {
    for (int i = 0; i < 3; ++i) hold(loading, mesh, "top", i, 0.0);
    hold(loading, mesh, "midpatch", 0, 0.005);
    hold(loading, mesh, "bottom", 2, -0.012);
  });
}

constexpr std::array kBetas{"0", "1", "10", "100", "1000"};

std::vector<Case> patch_cases() {
  std::vector<Case> cases;
  for (const std::string mesh : {"tet1", "cube5", "cube24"})
    for (const std::string problem : {"affine", "nonaffine", "clamp_pull"}) {
      if (mesh == "tet1" && problem == "clamp_pull") continue;
      for (const std::string model : {"L", "C", "G"})
        cases.push_back({mesh + "_" + problem + "_" + model, "1_patch", mesh, model, 0.0, 0.0, false,
                         mesh + "_" + problem + "_" + model, 1});
      for (const std::string beta : kBetas) {
        const std::string stem = mesh + "_" + problem + "_PSH_beta" + beta;
        cases.push_back({stem, "1_patch", mesh, "PSH", std::stod(beta), 0.0, false, stem, 1});
      }
    }
  return cases;
}

constexpr double kBarDensity = 1000.0;  // kg/m^3, as its parameters.json says

std::vector<Case> bar_cases() {
  std::vector<Case> cases;
  for (const std::string mesh : {"kuhn1", "kuhn2", "kuhn4", "unstr", "kuhn6", "kuhn8"}) {
    for (const std::string model : {"L", "C", "G"})
      cases.push_back({mesh + "_" + model, "2_bar", mesh, model, 0.0, kBarDensity, false, mesh + "_" + model, 4});
    for (const std::string beta : kBetas) {
      const std::string stem = mesh + "_PSH_beta" + beta;
      cases.push_back({stem, "2_bar", mesh, "PSH", std::stod(beta), kBarDensity, false, stem, 5});
    }
  }
  return cases;
}

std::vector<Case> vessel_cases() {
  std::vector<Case> cases;
  for (const std::string density : {"5.1", "500", "510", "5000"}) {
    std::string name = "rho" + density;
    std::replace(name.begin(), name.end(), '.', '_');
    for (const std::string model : {"L", "C", "G"})
      cases.push_back({model + "_" + name, "4_vessel_small", "mesh", model, 0.0, std::stod(density), false,
                       model + "_rho" + density, 4});
    for (const std::string beta : kBetas)
      cases.push_back({"PSH_beta" + beta + "_" + name, "4_vessel_small", "mesh", "PSH", std::stod(beta),
                       std::stod(density), false, "PSH_beta" + beta + "_rho" + density, 2});
  }
  for (const std::string model : {"L", "C", "G"})
    cases.push_back(
        {model + "_matched", "4_vessel_small", "mesh", model, 0.0, 500.0, true, model + "matched_rho500", 4});
  return cases;
}

const auto name_of_case = [](const testing::TestParamInfo<Case>& tested) { return tested.param.name; };
INSTANTIATE_TEST_SUITE_P(Models, Patch, testing::ValuesIn(patch_cases()), name_of_case);
INSTANTIATE_TEST_SUITE_P(Models, Bar, testing::ValuesIn(bar_cases()), name_of_case);
INSTANTIATE_TEST_SUITE_P(Models, Vessel, testing::ValuesIn(vessel_cases()), name_of_case);

}  // namespace
}  // namespace rhexis
