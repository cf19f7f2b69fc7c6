// A cube pulled along one or two axes against the closed form of nearly incompressible Mooney-Rivlin. The state is
// homogeneous, so every mesh holds the exact solution and only the Newton tolerance and rounding remain.

#include <gtest/gtest.h>

#include <cmath>

#include "mesh/generate.h"
#include "model/make_model.h"
#include "solver/equilibrium.h"
#include "tests/support/bodies.h"

namespace rhexis {
namespace {

const material::MooneyRivlin kLaw{2.0e4, 3.0e4, 1.0e6};
constexpr double kSide = 0.1;

/// Principal Cauchy stress of direction i at stretches l: W_M is isochoric, so its stress has no mean and lambda =
/// kappa (J - 1) is the mean.
double cauchy(const std::array<double, 3>& l, std::size_t i) {
  const double J = l[0] * l[1] * l[2];
  const double I1 = l[0] * l[0] + l[1] * l[1] + l[2] * l[2];
  const double I2 = 0.5 * (I1 * I1 - (std::pow(l[0], 4) + std::pow(l[1], 4) + std::pow(l[2], 4)));
  const double deviator = kLaw.c1 * std::pow(J, -2.0 / 3) * (2 * l[i] * l[i] - 2.0 / 3 * I1) +
                          kLaw.c2 * std::pow(J, -4.0 / 3) * (2 * l[i] * l[i] * (I1 - l[i] * l[i]) - 4.0 / 3 * I2);
  return deviator / J + kLaw.kappa * (J - 1);
}

/// The free stretch that makes the stress across it vanish, by bisection.
template <class Stretches>
double free_stretch(const Stretches& stretches, std::size_t across) {
  double low = 0.3;
  double high = 3.0;
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    (cauchy(stretches(middle), across) > 0 ? high : low) = middle;
  }
  return 0.5 * (low + high);
}

struct Pull {
  std::string name;
  model::ModelKind kind;
  double beta;
  double stretch;
};
std::ostream& operator<<(std::ostream& out, const Pull& pull) { return out << pull.name; }

class ClosedForm : public testing::TestWithParam<Pull> {
 protected:
  void solve(const std::vector<int>& pulled) {
    const Pull& pull = GetParam();
    model::ModelSettings settings;
    settings.kind = pull.kind;
    settings.law = kLaw;
    settings.beta = pull.beta;
    body_ = model::make_model(mesh_, settings);
    model::Loading loading = test::no_load(*body_);
    test::hold_symmetry(loading, mesh_, *body_);
    const std::array<std::string, 3> far{"+x", "+y", "+z"};
    for (const int axis : pulled)
      test::hold(loading, mesh_, *body_, far[static_cast<std::size_t>(axis)], axis, (pull.stretch - 1) * kSide);
    solver::Options options;
    options.steps = 4;
    options.tolerance = 1e-11;
    state_ = body_->initial_state();
    report_ = solver::solve_equilibrium(*body_, loading, options, state_);
    ASSERT_TRUE(report_.converged()) << report_.why;
  }

  /// Newton stops at 1e-11 of the forces; lambda feels it times kappa / mu = 10.
  static constexpr double kTight = 1e-9;
  mesh::TetMesh mesh_ = mesh::make_structured_box(Vec3::Constant(kSide), {2, 2, 2});
  std::unique_ptr<model::Model> body_;
  model::State state_;
  solver::Report report_;
};

TEST_P(ClosedForm, Uniaxial) {
  solve({2});
  const double l = GetParam().stretch;
  const auto stretches = [l](double a) { return std::array<double, 3>{a, a, l}; };
  const double a = free_stretch(stretches, 0);
  const double force = cauchy(stretches(a), 2) * a * a * kSide * kSide;
  EXPECT_NEAR(test::total(report_.reaction, *body_, mesh_, "+z", 2), force, kTight * std::abs(force));
  const double lambda = kLaw.kappa * (a * a * l - 1);
  for (const double value : state_.lambda)
    EXPECT_NEAR(value, lambda, kTight * std::abs(lambda) + kTight * kLaw.shear_modulus());
}

TEST_P(ClosedForm, Equibiaxial) {
  solve({0, 1});
  const double l = GetParam().stretch;
  const auto stretches = [l](double a) { return std::array<double, 3>{l, l, a}; };
  const double a = free_stretch(stretches, 2);
  const double force = cauchy(stretches(a), 0) * l * a * kSide * kSide;
  EXPECT_NEAR(test::total(report_.reaction, *body_, mesh_, "+x", 0), force, kTight * std::abs(force));
  EXPECT_NEAR(test::total(report_.reaction, *body_, mesh_, "+y", 1), force, kTight * std::abs(force));
}

INSTANTIATE_TEST_SUITE_P(Pulls, ClosedForm,
                         testing::Values(Pull{"PshBeta0Stretch1_5", model::ModelKind::hyperelastic, 0.0, 1.5},
                                         Pull{"PshBeta100Stretch1_5", model::ModelKind::hyperelastic, 100.0, 1.5},
                                         Pull{"PshBeta100Squeezed", model::ModelKind::hyperelastic, 100.0, 0.7},
                                         Pull{"TaylorHoodStretch1_3", model::ModelKind::taylor_hood, 0.0, 1.3}),
                         [](const auto& tested) { return tested.param.name; });

}  // namespace
}  // namespace rhexis
