#pragma once

/// Bodies on which beta is judged against Taylor-Hood on a refined mesh (docs/stabilisation.md).

#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "mesh/surface.h"
#include "model/make_model.h"
#include "solver/equilibrium.h"
#include "tests/support/kuhn_box.h"

namespace rhexis::test {

/// Says which positions in the reference configuration (m) belong to something.
using Where = std::function<bool(const Vec3&)>;

struct Support {
  Where where;
  std::vector<int> components;
  double value = 0.0;  ///< m
};

/// What acts, said in space and not in nodes: the same for P1 and P2, for a mesh and its refinement.
struct StudyBody {
  mesh::TetMesh mesh;
  double young = 1e5;  ///< Pa
  int steps = 4;
  std::vector<Support> supports;
  Vec3 body_force = Vec3::Zero();  ///< N/m^3
  Vec3 traction = Vec3::Zero();    ///< Pa, dead
  Where traction_on;               ///< faces with all three corners there
};

inline constexpr double kNear = 1e-9;  ///< m
inline Where everywhere_at(int component, double value) {
  return [=](const Vec3& x) { return std::abs(x[component] - value) < kNear; };
}

/// A cantilever 0.1 x 0.1 x 0.4 m along z, bent by its weight.
inline StudyBody make_bar_body(mesh::TetMesh mesh) {
  StudyBody body;
  body.mesh = std::move(mesh);
  body.supports = {{everywhere_at(2, 0.0), {0, 1, 2}}};
  body.body_force = Vec3(0, -9810, 0);
  return body;
}

/// n x n x 4 n cells.
inline StudyBody make_bar_body(int n) {
  return make_bar_body(
      make_kuhn_box({.cells = {n, n, 4 * n}, .map = [n](const Vec3& x) { return Vec3(x * (0.1 / n)); }}));
}

/// Cook's membrane in plane strain, 48 x 44 to 60 mm, 12 mm thick: n x n x max(1, n / 4) cells.
inline StudyBody make_cook_body(int n) {
  const int layers = std::max(1, n / 4);
  StudyBody body;
  body.mesh =
      make_kuhn_box({.cells = {n, n, layers},
                     .jitter = Vec3(0.15, 0.15, 0.0),
                     .jitter_last_sides = true,
                     .map = [n, layers](const Vec3& x) {
                       const double xi = x[0] / n;
                       return Vec3(0.048 * xi, 0.044 * xi + (0.044 - 0.028 * xi) * x[1] / n, 0.012 * x[2] / layers);
                     }});
  body.supports = {{everywhere_at(0, 0.0), {0, 1, 2}}, {everywhere_at(2, 0.0), {2}}, {everywhere_at(2, 0.012), {2}}};
  body.traction = Vec3(0, 12000, 0);
  body.traction_on = everywhere_at(0, 0.048);
  return body;
}

/// A quarter of a block 0.2 x 0.2 x 0.05 m, pressed down on the middle quarter of its top: n x n x n / 2 cells.
inline StudyBody make_foot_body(int n, bool mirrored) {
  StudyBody body;
  body.mesh = make_kuhn_box(
      {.cells = {n, n, n / 2}, .mirrored = mirrored, .map = [n](const Vec3& x) { return Vec3(x * (0.1 / n)); }});
  body.supports = {{everywhere_at(2, 0.0), {0, 1, 2}}, {everywhere_at(0, 0.0), {0}}, {everywhere_at(1, 0.0), {1}}};
  body.traction = Vec3(0, 0, -25000);
  body.traction_on = [](const Vec3& x) { return x.z() > 0.05 - kNear && x.x() < 0.05 + kNear && x.y() < 0.05 + kNear; };
  return body;
}

/// A tube, radii 2.5 and 5 mm, 40 mm long: the top held, the bottom pulled down by 12 mm, a patch half way up pushed 5
/// mm in x; one cell through the wall. The circle is a polygon, in the refinement too, so that both are the same body.
inline StudyBody make_tube_body(int around, int along) {
  StudyBody body;
  body.mesh = make_kuhn_box(
      {.cells = {around, 1, along}, .closed = true, .jitter = Vec3::Zero(), .map = [around, along](const Vec3& x) {
         const double angle = 2.0 * std::numbers::pi * x[0] / around;
         const double r = 0.0025 + 0.0025 * x[1];
         return Vec3(r * std::cos(angle), r * std::sin(angle), 0.04 * x[2] / along);
       }});
  body.young = 1e6;
  body.steps = 2;
  body.body_force = Vec3(0, 0, -9.81 * 500);
  // The patch holds the same facets whatever the mesh along z and its refinement: half a cell beyond one or two cells.
  const double outer = 0.005 * std::cos(std::numbers::pi / around) - kNear;
  const double side = around == 12 ? -0.86 : around == 10 ? -0.80 : -0.70;
  const double half_height = along % 8 == 0 ? 0.0051 : 0.0034;
  const Where patch = [=](const Vec3& x) {
    const double r = std::hypot(x.x(), x.y());
    return r > outer && x.x() < side * r && std::abs(x.z() - 0.02) < half_height;
  };
  body.supports = {{everywhere_at(2, 0.04), {0, 1, 2}}, {everywhere_at(2, 0.0), {2}, -0.012}, {patch, {0}, 0.005}};
  return body;
}

inline model::Loading loading_of(const StudyBody& body, const mesh::TetMesh& mesh, const model::Model& model) {
  const model::DisplacementSpace& space = model.space();
  std::map<std::int32_t, double> held;
  for (const Support& support : body.supports)
    for (std::size_t n = 0; n < space.node_count(); ++n)
      if (support.where(space.nodes[n]))
        for (const int c : support.components) held[static_cast<std::int32_t>(3 * n) + c] = support.value;
  model::Loading loading;
  for (const auto& [dof, value] : held) loading.supports.push_back({dof, value});

  loading.dead_force = VectorX::Zero(static_cast<Eigen::Index>(space.dof_count()));
  model::add_body_force(mesh, space, body.body_force, loading.dead_force);
  if (body.traction_on) {
    std::vector<mesh::TetFace> faces;
    double area = 0.0;
    for (const mesh::TetFace face : mesh::find_faces(mesh).boundary) {
      const std::array<NodeId, 3> nodes = mesh::face_nodes(mesh, face);
      if (!std::all_of(nodes.begin(), nodes.end(), [&](NodeId n) { return body.traction_on(mesh.node(n)); })) continue;
      faces.push_back(face);
      area += mesh::face_area(mesh, face);
    }
    model::add_traction(mesh, space, faces, body.traction * area, loading.dead_force);
  }
  return loading;
}

struct Answer {
  bool converged = false;
  std::vector<Vec3> u;         ///< at the nodes of the mesh, m
  std::vector<double> lambda;  ///< mean over each tet, Pa
  double min_J = 0.0;
  int iterations = 0;
};

/// Equilibrium on `mesh`, which is body.mesh or a refinement of it. beta is read by `hyperelastic` alone.
inline Answer solve(const StudyBody& body, const mesh::TetMesh& mesh, double nu, model::ModelKind kind, double beta) {
  model::ModelSettings settings;
  settings.kind = kind;
  settings.law = material::to_mooney_rivlin({body.young, nu});
  settings.beta = beta;
  const std::unique_ptr<model::Model> model = model::make_model(mesh, settings);
  model::State state = model->initial_state();
  const solver::Report report = solver::solve_equilibrium(*model, loading_of(body, mesh, *model),
                                                          {.tolerance = 1e-9, .steps = body.steps}, state);
  EXPECT_TRUE(report.converged()) << report.why;

  Answer answer;
  answer.converged = report.converged();
  for (std::size_t n = 0; n < mesh.node_count(); ++n)
    answer.u.push_back(state.u.segment<3>(static_cast<Eigen::Index>(3 * n)));
  for (std::size_t t = 0; t < mesh.tet_count(); ++t) {
    if (!model->pressure_at_vertices()) {
      answer.lambda.push_back(state.lambda[static_cast<Eigen::Index>(t)]);
      continue;
    }
    double sum = 0.0;
    for (const NodeId n : mesh.tets[t]) sum += state.lambda[n.value()];
    answer.lambda.push_back(sum / 4.0);
  }
  const std::vector<double> J = model->fields(state).J;
  answer.min_J = *std::min_element(J.begin(), J.end());
  for (const solver::StepReport& step : report.steps) answer.iterations += step.iterations;
  return answer;
}

/// An answer on a refinement, seen on the coarse mesh: u at its nodes, lambda as the mean over its tets.
inline Answer seen_on(const mesh::TetMesh& coarse, const mesh::TetMesh& fine, Answer answer) {
  const std::size_t children = fine.tet_count() / coarse.tet_count();
  std::vector<double> means;
  for (std::size_t t = 0; t < coarse.tet_count(); ++t) {
    double sum = 0.0;
    double volume = 0.0;
    for (std::size_t child = children * t; child < children * (t + 1); ++child) {
      const double v = mesh::signed_volume(fine, TetId(child));
      sum += v * answer.lambda[child];
      volume += v;
    }
    means.push_back(sum / volume);
  }
  answer.lambda = means;
  answer.u.resize(coarse.node_count());
  return answer;
}

struct StudyErrors {
  double u = 0.0;       ///< relative, L2
  double lambda = 0.0;  ///< relative, L2 of tet means
};

inline StudyErrors errors_of(const mesh::TetMesh& mesh, const Answer& answer, const Answer& reference) {
  double du = 0.0, u = 0.0, dlambda = 0.0, lambda = 0.0;
  for (std::size_t t = 0; t < mesh.tet_count(); ++t) {
    const double v = mesh::signed_volume(mesh, TetId(t));
    dlambda += v * std::pow(answer.lambda[t] - reference.lambda[t], 2);
    lambda += v * std::pow(reference.lambda[t], 2);
    // P1 mass matrix: v / 20 (1 + delta_ij), so the integral is v / 20 (|sum|^2 + sum of |.|^2).
    Vec3 sum_d = Vec3::Zero(), sum_u = Vec3::Zero();
    for (const NodeId n : mesh.tets[t]) {
      const Vec3 d = answer.u[n.index()] - reference.u[n.index()];
      sum_d += d;
      sum_u += reference.u[n.index()];
      du += v / 20 * d.squaredNorm();
      u += v / 20 * reference.u[n.index()].squaredNorm();
    }
    du += v / 20 * sum_d.squaredNorm();
    u += v / 20 * sum_u.squaredNorm();
  }
  return {std::sqrt(du / u), std::sqrt(dlambda / lambda)};
}

/// Size of the jumps of lambda from tet to tet over the size of lambda: RMS over the inner faces over the mean of
/// |lambda|.
inline double oscillation(const mesh::TetMesh& mesh, const Answer& answer) {
  double jumps = 0.0, area = 0.0, size = 0.0, volume = 0.0;
  for (const mesh::InteriorFace& face : mesh::find_faces(mesh).interior) {
    const double a = mesh::face_area(mesh, face.first);
    jumps += a * std::pow(answer.lambda[face.first.tet.index()] - answer.lambda[face.second.tet.index()], 2);
    area += a;
  }
  for (std::size_t t = 0; t < mesh.tet_count(); ++t) {
    const double v = mesh::signed_volume(mesh, TetId(t));
    size += v * std::abs(answer.lambda[t]);
    volume += v;
  }
  return std::sqrt(jumps / area) / (size / volume);
}

}  // namespace rhexis::test
