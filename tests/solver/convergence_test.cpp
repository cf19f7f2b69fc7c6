// Convergence orders on a manufactured solution: u is given, the load is what the weak form needs for it.

#include <gtest/gtest.h>

#include <cmath>

#include <Eigen/Dense>

#include "mesh/generate.h"
#include "mesh/surface.h"
#include "model/make_model.h"
#include "solver/equilibrium.h"
#include "tests/support/measured.h"
#include "tests/support/tet_quadrature.h"

namespace rhexis {
namespace {

/// Smooth, of no symmetry that a mesh could profit from, strains of about 10%.
Vec3 exact_u(const Vec3& x) {
  return 0.02 * Vec3(std::sin(2 * x.y() + x.z()) + x.x() * x.x(), std::cos(2 * x.z()) * x.x(),
                     std::sin(x.x() + 2 * x.y()) * x.z());
}

Mat3 exact_gradient(const Vec3& x) {
  Mat3 g;
  g << 2 * x.x(), 2 * std::cos(2 * x.y() + x.z()), std::cos(2 * x.y() + x.z()),  //
      std::cos(2 * x.z()), 0, -2 * std::sin(2 * x.z()) * x.x(),                  //
      std::cos(x.x() + 2 * x.y()) * x.z(), 2 * std::cos(x.x() + 2 * x.y()) * x.z(), std::sin(x.x() + 2 * x.y());
  return 0.02 * g;
}

/// First Piola-Kirchhoff stress of the exact solution, written out plainly.
Mat3 exact_stress(const model::ModelSettings& s, const Mat3& gradient) {
  if (s.kind == model::ModelKind::linear) {
    const Mat3 strain = 0.5 * (gradient + gradient.transpose());
    return s.elastic.lame_lambda() * strain.trace() * Mat3::Identity() + 2 * s.elastic.lame_mu() * strain;
  }
  const Mat3 F = Mat3::Identity() + gradient;
  const Mat3 C = F.transpose() * F;
  const double J = F.determinant();
  const double I1 = C.trace();
  const double I2 = 0.5 * (I1 * I1 - (C * C).trace());
  const Mat3 F_inv_T = F.inverse().transpose();
  const Mat3 dI1bar = std::pow(J, -2.0 / 3) * (2 * F - 2.0 / 3 * I1 * F_inv_T);
  const Mat3 dI2bar = std::pow(J, -4.0 / 3) * (2 * I1 * F - 2 * F * C - 4.0 / 3 * I2 * F_inv_T);
  return s.law.c1 * dI1bar + s.law.c2 * dI2bar + s.law.kappa * (J - 1) * J * F_inv_T;
}

struct Errors {
  double u_l2 = 0.0;
  double u_h1 = 0.0;
  double lambda_l2 = 0.0;
};

Errors solve_and_measure(const model::ModelSettings& settings, int cells) {
  const mesh::TetMesh mesh = mesh::make_structured_box(Vec3::Ones(), {cells, cells, cells});
  const std::unique_ptr<model::Model> body = model::make_model(mesh, settings);
  const model::DisplacementSpace& space = body->space();
  const auto width = static_cast<std::size_t>(space.nodes_per_tet());

  model::Loading loading;
  loading.dead_force = VectorX::Zero(static_cast<Eigen::Index>(space.dof_count()));
  for (std::size_t t = 0; t < mesh.tet_count(); ++t) {
    const std::array<Vec3, 4> x = mesh::corners(mesh, TetId(t));
    const auto g = test::barycentric_gradients(x);
    const double volume = mesh::signed_volume(mesh, TetId(t));
    for (const test::TetPoint& point : test::tet_points()) {
      Vec3 at = Vec3::Zero();
      for (std::size_t k = 0; k < 4; ++k) at += point.barycentric[k] * x[k];
      const Mat3 P = exact_stress(settings, exact_gradient(at));
      const test::Shapes shapes = test::shapes_at(space.order, point.barycentric, g);
      for (std::size_t k = 0; k < width; ++k)
        loading.dead_force.segment<3>(3 * space.connectivity[width * t + k]) +=
            volume * point.weight * (P * shapes.gradient[k]);
    }
  }
  for (std::size_t n = 0; n < space.node_count(); ++n) {
    const Vec3& x = space.nodes[n];
    if (x.minCoeff() > 1e-9 && x.maxCoeff() < 1 - 1e-9) continue;
    const Vec3 u = exact_u(x);
    for (int i = 0; i < 3; ++i) loading.supports.push_back({static_cast<std::int32_t>(3 * n) + i, u[i]});
  }

  solver::Options options;
  options.steps = 1;
  options.tolerance = 1e-10;
  model::State state = body->initial_state();
  const solver::Report report = solver::solve_equilibrium(*body, loading, options, state);
  EXPECT_TRUE(report.converged()) << report.why;

  Errors errors;
  for (std::size_t t = 0; t < mesh.tet_count(); ++t) {
    const std::array<Vec3, 4> x = mesh::corners(mesh, TetId(t));
    const auto g = test::barycentric_gradients(x);
    const double volume = mesh::signed_volume(mesh, TetId(t));
    for (const test::TetPoint& point : test::tet_points()) {
      Vec3 at = Vec3::Zero();
      for (std::size_t k = 0; k < 4; ++k) at += point.barycentric[k] * x[k];
      const test::Shapes shapes = test::shapes_at(space.order, point.barycentric, g);
      Vec3 u = Vec3::Zero();
      Mat3 gradient = Mat3::Zero();
      for (std::size_t k = 0; k < width; ++k) {
        const Vec3 nodal = state.u.segment<3>(3 * space.connectivity[width * t + k]);
        u += shapes.value[k] * nodal;
        gradient += nodal * shapes.gradient[k].transpose();
      }
      errors.u_l2 += volume * point.weight * (u - exact_u(at)).squaredNorm();
      errors.u_h1 += volume * point.weight * (gradient - exact_gradient(at)).squaredNorm();
      if (body->pressure_at_vertices()) {
        double lambda = 0.0;
        for (std::size_t k = 0; k < 4; ++k) lambda += point.barycentric[k] * state.lambda[mesh.tets[t][k].value()];
        const double exact = settings.law.kappa * ((Mat3::Identity() + exact_gradient(at)).determinant() - 1);
        errors.lambda_l2 += volume * point.weight * std::pow(lambda - exact, 2);
      }
    }
  }
  return {std::sqrt(errors.u_l2), std::sqrt(errors.u_h1), std::sqrt(errors.lambda_l2)};
}

/// The order that the last halving of h shows.
double order(double coarse, double fine) { return std::log2(coarse / fine); }

TEST(Convergence, LinearModelIsSecondOrderInDisplacement) {
  model::ModelSettings settings;
  settings.kind = model::ModelKind::linear;
  settings.elastic = {1e5, 0.3};
  const Errors coarse = solve_and_measure(settings, 4);
  const Errors fine = solve_and_measure(settings, 8);
  test::measured("linear: order {:.2f} in L2, {:.2f} in H1", order(coarse.u_l2, fine.u_l2),
                 order(coarse.u_h1, fine.u_h1));
  // Theory: 2 and 1, from below on meshes this coarse.
  EXPECT_GT(order(coarse.u_l2, fine.u_l2), 1.85);
  EXPECT_GT(order(coarse.u_h1, fine.u_h1), 0.95);
}

TEST(Convergence, TaylorHoodIsThirdOrderInDisplacementAndSecondInLambda) {
  model::ModelSettings settings;
  settings.kind = model::ModelKind::taylor_hood;
  settings.law = {1e4, 0.5e4, 5e5};
  const Errors coarse = solve_and_measure(settings, 3);
  const Errors fine = solve_and_measure(settings, 6);
  test::measured("taylor-hood: order {:.2f} in L2, {:.2f} in H1, lambda {:.2f} in L2", order(coarse.u_l2, fine.u_l2),
                 order(coarse.u_h1, fine.u_h1), order(coarse.lambda_l2, fine.lambda_l2));
  // Theory: 3, 2 and 2, from below on meshes this coarse.
  EXPECT_GT(order(coarse.u_l2, fine.u_l2), 2.8);
  EXPECT_GT(order(coarse.u_h1, fine.u_h1), 1.8);
  EXPECT_GT(order(coarse.lambda_l2, fine.lambda_l2), 1.8);
}

}  // namespace
}  // namespace rhexis
