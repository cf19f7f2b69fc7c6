// The energy release of bodies of large strain, model by model, against the strip of Rivlin and Thomas (1953), which it
// crosses at no cost but its energy, against differences of energies, and against small strains.

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <random>

#include <Eigen/Geometry>

#include "element/linear_tet.h"
#include "fracture/energy_release.h"
#include "model/make_model.h"
#include "model/stabilisation.h"
#include "solver/equilibrium.h"
#include "tests/fracture/cracked_plate.h"
#include "tests/support/measured.h"

namespace rhexis::fracture::test {
namespace {

using model::ModelKind;
using rhexis::test::measured;

model::ModelSettings settings_of(ModelKind kind, double poisson = 0.45, bool neo_hookean = false) {
  model::ModelSettings out;
  out.kind = kind;
  out.elastic = {.young = 1.0e5, .poisson = poisson};
  out.law = material::to_mooney_rivlin(out.elastic, neo_hookean);
  out.beta = model::auto_beta(out.law);
  return out;
}

/// A cracked body in equilibrium.
class Strained {
 public:
  Strained(const mesh::TetMesh& mesh, const model::ModelSettings& settings, const WholeProblem& problem, int steps = 4)
      : body_(mesh), settings_(settings), body_force_(problem.body_force), edge_(Surroundings(mesh).mean_edge()) {
    model_ = model::make_model(mesh, settings_);
    model::Loading loading;
    for (const auto& [dof, value] : problem.given) loading.supports.push_back({dof, value});
    loading.dead_force = VectorX::Zero(static_cast<Eigen::Index>(model_->space().dof_count()));
    model::add_body_force(mesh, model_->space(), body_force_, loading.dead_force);
    state = model_->initial_state();
    const solver::Report report =
        solver::solve_equilibrium(*model_, loading, {.tolerance = 1e-9, .steps = steps}, state);
    EXPECT_TRUE(report.converged()) << report.why;
  }

  [[nodiscard]] double energy() const { return model_->energy(state); }  ///< J, stored
  [[nodiscard]] double edge() const { return edge_; }
  [[nodiscard]] const mesh::TetMesh& mesh() const { return body_.mesh(); }

  /// With q from `inner` to `outer` mean edges.
  [[nodiscard]] double release(const Crack& crack, double inner = kInnerEdges, double outer = kOuterEdges) const {
    std::vector<EnergyTet> tets;
    for (std::size_t t = 0; t < mesh().tet_count(); ++t) {
      std::array<Vec3, 4> u;
      for (std::size_t k = 0; k < 4; ++k) u[k] = state.u.segment<3>(3 * Eigen::Index{mesh().tets[t][k].value()});
      const Mat3 gradient =
          element::displacement_gradient(element::make_linear_tet(mesh::corners(mesh(), TetId(t))), u);
      const model::TetState tet = model_->tet_state(state, TetId(t), Mat3::Identity() + gradient);
      tets.push_back({TetId(t), gradient, tet.P, tet.W});
    }
    return energy_release(body_, crack, tets, {inner * edge_, outer * edge_}, body_force_)[0];
  }

  /// Less the derivative of the energy, at displacements and pressures as they are, by the places of the nodes, moved
  /// by q d; per length of front.
  [[nodiscard]] double configurational_force(const Crack& crack) const {
    const FrontPoint& front = crack.front[0];
    const auto energy_moved = [&](double by) {
      mesh::TetMesh moved = mesh();
      for (Vec3& x : moved.nodes) {
        const Vec3 way = x - front.position;
        const double distance = (way - way.dot(front.tangent) * front.tangent).norm() / edge_;
        x += by * std::clamp((kOuterEdges - distance) / (kOuterEdges - kInnerEdges), 0.0, 1.0) * front.direction;
      }
      return model::make_model(moved, settings_)->energy(state);
    };
    const double step = 1e-4 * edge_;
    return (energy_moved(-step) - energy_moved(step)) /
           (2.0 * step * (crack.front[1].position - crack.front[0].position).norm());
  }

  /// Of the nodes that nothing holds, relative to all forces.
  [[nodiscard]] double residual(const WholeProblem& problem) const {
    const auto scratch = model_->make_scratch();
    model::Residual out{VectorX::Zero(state.u.size()), VectorX::Zero(state.lambda.size())};
    model_->residual(state, *scratch, out);
    const double all = out.u.norm();
    for (const auto& [dof, value] : problem.given) out.u[dof] = 0.0;
    return out.u.norm() / all;
  }

  model::State state;

 private:
  mesh::TornMesh body_;
  model::ModelSettings settings_;
  Vec3 body_force_;
  double edge_ = 0.0;
  std::unique_ptr<model::Model> model_;
};

/// A sheet between clamps that move apart, free to grow thin, cracked from one end: `cells` over its height of 0.1 m.
struct Strip {
  static constexpr double kHeight = 0.1;
  Strip(int cells, double heights, double crack_heights, double stretch, double jitter = 0.0) {
    const double h = kHeight / cells;
    const int crack_cells = static_cast<int>(std::lround(crack_heights * cells));
    mesh = cracked_plate(Vec3(heights * kHeight, kHeight, h),
                         {static_cast<int>(std::lround(heights * cells)), cells, 1}, crack_cells, jitter);
    crack = front_at(crack_cells * h, 0.5 * kHeight, h);
    for (const double sign : {-1.0, 1.0}) {
      const char* side = sign < 0.0 ? "-y" : "+y";
      problem.hold(mesh, side, 0, 0.0);
      problem.hold(mesh, side, 1, sign * 0.5 * (stretch - 1.0) * kHeight);
    }
    for (std::size_t node = 0; node < mesh.node_count(); ++node)  // doubled nodes stand in no set
      if (std::abs(mesh.nodes[node][2]) < 1e-9) problem.given[3 * static_cast<std::int32_t>(node) + 2] = 0.0;
  }
  mesh::TetMesh mesh;
  Crack crack;
  WholeProblem problem;
};

/// J/m^3, of a thin sheet stretched by `stretch` along y, held along x and free along z.
double pure_shear_energy(const model::ModelSettings& settings, double stretch) {
  const auto energy = [&](double z) {
    if (settings.kind == ModelKind::hyperelastic) {
      const double J = stretch * z;
      const double I1 = stretch * stretch + z * z + 1.0;
      const double I2 = stretch * stretch * z * z + stretch * stretch + z * z;
      return settings.law.c1 * (I1 * std::pow(J, -2.0 / 3.0) - 3.0) +
             settings.law.c2 * (I2 * std::pow(J, -4.0 / 3.0) - 3.0) + 0.5 * settings.law.kappa * (J - 1.0) * (J - 1.0);
    }
    const auto strain = [&](double s) { return settings.kind == ModelKind::corotated ? s - 1.0 : 0.5 * (s * s - 1.0); };
    const double y_strain = strain(stretch);
    const double z_strain = strain(z);
    return settings.elastic.lame_mu() * (y_strain * y_strain + z_strain * z_strain) +
           0.5 * settings.elastic.lame_lambda() * std::pow(y_strain + z_strain, 2);
  };
  double low = 0.3, high = 1.2;  // the least energy: no stress along z
  for (int i = 0; i < 200; ++i) {
    const double third = (high - low) / 3.0;
    (energy(low + third) < energy(high - third) ? high : low) +=
        energy(low + third) < energy(high - third) ? -third : third;
  }
  return energy(0.5 * (low + high));
}

struct LawCase {
  std::string name;
  model::ModelSettings settings;
  double stretch = 1.3;

  friend std::ostream& operator<<(std::ostream& out, const LawCase& c) { return out << c.name; }
};

class LargeStrainRelease : public testing::TestWithParam<LawCase> {};

INSTANTIATE_TEST_SUITE_P(All, LargeStrainRelease,
                         testing::Values(LawCase{"corotated", settings_of(ModelKind::corotated)},
                                         LawCase{"st_venant_kirchhoff",
                                                 settings_of(ModelKind::geometrically_nonlinear)},
                                         LawCase{"mooney_rivlin", settings_of(ModelKind::hyperelastic), 1.5},
                                         LawCase{"neo_hookean", settings_of(ModelKind::hyperelastic, 0.49, true), 1.5}),
                         [](const auto& tested) { return tested.param.name; });

TEST_P(LargeStrainRelease, OfAPureShearStripIsItsEnergyTimesItsHeight) {
  const double expected = pure_shear_energy(GetParam().settings, GetParam().stretch) * Strip::kHeight;
  double last = 0.03;
  for (const int cells : {8, 16}) {
    const Strip strip(cells, 8.0, 4.0, GetParam().stretch);
    const Strained body(strip.mesh, GetParam().settings, strip.problem);
    const double G = body.release(strip.crack);
    measured("strip {} {} cells, {:.2f} mm: G {:.2f} of {:.2f} N/m, {:+.2f}%", GetParam().name, cells,
             1e3 * body.edge(), G, expected, 100.0 * (G / expected - 1.0));
    // First order in h, as linear tets next to a tip can; the ends of the strip are felt by less than 0.2%.
    EXPECT_LT(std::abs(G / expected - 1.0), last);
    last = std::abs(G / expected - 1.0);
  }
}

TEST_P(LargeStrainRelease, IsTheDerivativeOfTheEnergyByThePlacesOfTheNodes) {
  const Strip strip(8, 4.0, 2.0, GetParam().stretch, 0.2);
  model::ModelSettings settings = GetParam().settings;
  const auto error = [&] {
    const Strained body(strip.mesh, settings, strip.problem);
    return body.release(strip.crack) / body.configurational_force(strip.crack) - 1.0;
  };
  if (model::is_mixed(settings.kind)) {
    EXPECT_LT(std::abs(error()), 0.01);  // the derivative of the jump terms, which is left out
    settings.beta = 0.0;
  }
  EXPECT_LT(std::abs(error()), 1e-7);  // what rounding and truncation leave of the difference
}

TEST_P(LargeStrainRelease, IsTheEnergyThatALongerCrackSetsFree) {
  // Square, a crack of 6 of 24 cells, the ends held.
  const auto strip_of = [](int cells) { return Strip(24, 1.0, cells / 24.0, GetParam().stretch); };
  const auto energy = [&](int cells) {
    const Strip strip = strip_of(cells);
    return Strained(strip.mesh, GetParam().settings, strip.problem).energy();
  };
  const double h = Strip::kHeight / 24;
  const double difference = (energy(5) - energy(7)) / (2.0 * h * h);
  const Strip strip = strip_of(6);
  const double G = Strained(strip.mesh, GetParam().settings, strip.problem).release(strip.crack);
  measured("longer {}: G {:.2f}, difference {:.2f} N/m", GetParam().name, G, difference);
  // The difference's own error is of order (h / a)^2, G's of order h / a, with a = 6 cells and a tenth of it.
  EXPECT_NEAR(G, difference, 0.01 * difference);
}

TEST_P(LargeStrainRelease, DoesNotDependOnItsDomain) {
  const Strip strip(24, 2.0, 1.0, GetParam().stretch, 0.2);
  const Strained body(strip.mesh, GetParam().settings, strip.problem);
  const double G = body.release(strip.crack);
  for (const auto& [inner, outer] : {std::pair{1.0, 5.0}, {2.0, 4.0}, {3.0, 6.0}, {4.0, 8.0}})
    EXPECT_NEAR(body.release(strip.crack, inner, outer), G, 0.015 * G) << inner << " to " << outer;
}

/// The plate of 6_fracture_modeI, which nothing holds near its crack, pulled `times` as far.
struct Plate {
  explicit Plate(double times) : problem(pulled_plate(mesh, Mode::opening)) {
    for (auto& [dof, value] : problem.given) value *= times;
  }
  mesh::TetMesh mesh = cracked_plate(Vec3(0.24, 0.24, 0.01), {24, 24, 1}, 6);
  Crack crack = front_at(0.06, 0.12, 0.01);
  WholeProblem problem;
};

TEST_P(LargeStrainRelease, TurnsWithTheBodyAndIsNearForAStateNearEquilibrium) {
  const Plate plate(120.0 * (GetParam().stretch - 1.0));
  Strained body(plate.mesh, GetParam().settings, plate.problem);
  const double G = body.release(plate.crack);
  const model::State still = body.state;
  const Mat3 Q = Eigen::AngleAxisd(2.2, Vec3(1.0, 0.5, -2.0).normalized()).toRotationMatrix();
  const auto turn = [&] {
    for (std::size_t node = 0; node < body.mesh().node_count(); ++node) {
      const Vec3& X = body.mesh().nodes[node];
      const auto at = static_cast<Eigen::Index>(3 * node);
      body.state.u.segment<3>(at) = (Q * (X + body.state.u.segment<3>(at)) - X).eval();
    }
  };
  turn();
  EXPECT_NEAR(body.release(plate.crack), G, 1e-7 * G);  // as far as the forces balance

  for (const double amount : {1e-5, 1e-4}) {
    body.state = still;
    for (std::size_t node = 0; node < body.mesh().node_count(); ++node) {
      const Vec3& X = body.mesh().nodes[node];
      const double wave = amount * std::sin(40.0 * X[0] + 1.0) * std::sin(40.0 * X[1]);
      body.state.u.segment<3>(static_cast<Eigen::Index>(3 * node)) += wave * Vec3(1.0, -1.0, 0.5);
    }
    const double residual = body.residual(plate.problem);
    const double error = body.release(plate.crack) / G - 1.0;
    turn();
    const double turned = body.release(plate.crack) / G - 1.0;
    measured("out of balance {}: residual {:.1e}, G {:+.1e}, turned {:+.1e}", GetParam().name, residual, error, turned);
    EXPECT_GT(residual, 1e-4);
    EXPECT_LT(std::abs(error), residual);
    EXPECT_LT(std::abs(turned), residual);
  }
}

TEST_P(LargeStrainRelease, TendsToThatOfSmallStrains) {
  const auto pulled = [](ModelKind kind, double times) {
    const Plate plate(times);
    model::ModelSettings settings = GetParam().settings;
    settings.kind = kind;
    return Strained(plate.mesh, settings, plate.problem).release(plate.crack) / (times * times);
  };
  const ModelKind kind = GetParam().settings.kind;
  const std::array<double, 3> G{pulled(kind, 0.4), pulled(kind, 0.2), pulled(kind, 0.1)};
  EXPECT_NEAR((G[0] - G[1]) / (G[1] - G[2]), 2.0, 0.05);  // first order in the strain
  const double limit = 2.0 * G[2] - G[1];
  const double linear = pulled(ModelKind::linear, 1.0);
  measured("limit {}: G {:.5f} N/m at 0.1 mm and {:.5f} in the limit, linear {:.5f}", GetParam().name, G[2], limit,
           linear);
  EXPECT_NEAR(limit, linear, (model::is_mixed(kind) ? 1e-2 : 1e-4) * linear);  // mixed: another discretisation
}

TEST(LargeStrainRelease, CountsTheWorkOfTheBodyForce) {
  // Hanging by its top, heavy enough to open the crack: without the force's own term the domains disagree.
  const mesh::TetMesh mesh = cracked_plate(Vec3(0.24, 0.24, 0.01), {48, 48, 1}, 12);
  WholeProblem problem;
  problem.body_force = Vec3(0.0, -4.0e4, 0.0);
  for (int i = 0; i < 3; ++i) problem.hold(mesh, "+y", i, 0.0);
  const Strained body(mesh, settings_of(ModelKind::geometrically_nonlinear), problem);
  const Crack crack = front_at(0.06, 0.12, 0.01);
  const double small = body.release(crack, 1.0, 3.0);
  EXPECT_NEAR(body.release(crack, 5.0, 9.0), small, 0.02 * small);
}

TEST(PureShear, IsThatOfRivlinAndThomas) {
  // Incompressible neo-Hookean: W0 = mu / 2 (s - 1 / s)^2.
  const model::ModelSettings settings = settings_of(ModelKind::hyperelastic, 0.4999, true);
  const double expected = 0.5 * settings.law.shear_modulus() * std::pow(1.5 - 1.0 / 1.5, 2);
  EXPECT_NEAR(pure_shear_energy(settings, 1.5), expected, 1e-3 * expected);
}

}  // namespace
}  // namespace rhexis::fracture::test
