#pragma once

/// Meshes, states and dense matrices for the tests of the models on linear tets.

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <ostream>
#include <random>
#include <string>
#include <vector>

#include <Eigen/Dense>

#include "mesh/generate.h"
#include "model/make_model.h"

namespace rhexis::test {

inline constexpr material::Elastic kElastic{1e5, 0.4};
inline constexpr material::MooneyRivlin kLaw{2e4, 3e4, 1e6};

/// A box of distorted tets, no two alike.
inline mesh::TetMesh distorted_box(const std::array<int, 3>& cells, double shake = 0.15, unsigned seed = 3) {
  mesh::TetMesh mesh = mesh::make_structured_box(Vec3(0.1 * cells[0], 0.1 * cells[1], 0.1 * cells[2]), cells);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> offset(-0.1 * shake, 0.1 * shake);
  for (Vec3& x : mesh.nodes) x += Vec3(offset(random), offset(random), offset(random));
  return mesh;
}

/// Large rotation about no axis in particular, a stretch of up to 1.2 and noise: J stays within 0.5 and 2.
inline model::State random_state(const mesh::TetMesh& mesh, std::int32_t pressures, unsigned seed = 7) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  Mat3 gradient = Eigen::AngleAxisd(0.9, Vec3(1.0, -2.0, 0.5).normalized()).toRotationMatrix();
  Mat3 stretch = Mat3::Identity();
  stretch(0, 0) = 1.2;
  stretch(1, 1) = 0.9;
  stretch(0, 2) = 0.1;
  gradient = gradient * stretch - Mat3::Identity();
  model::State state;
  state.u.resize(static_cast<Eigen::Index>(3 * mesh.node_count()));
  for (std::size_t n = 0; n < mesh.node_count(); ++n) {
    state.u.segment<3>(static_cast<Eigen::Index>(3 * n)) =
        gradient * mesh.nodes[n] + 0.006 * Vec3(unit(random), unit(random), unit(random));
  }
  state.lambda.resize(pressures);
  for (double& value : state.lambda) value = 5e4 * unit(random);
  return state;
}

struct P1Case {
  std::string name;
  model::ModelSettings settings;

  friend std::ostream& operator<<(std::ostream& out, const P1Case& c) { return out << c.name; }
};

/// Every P1 finite element model, law, tangent and a spread of betas.
inline std::vector<P1Case> p1_cases() {
  const auto make = [](const char* name, model::ModelKind kind, double beta = 0.0) {
    model::ModelSettings settings;
    settings.kind = kind;
    settings.elastic = kElastic;
    settings.law = kLaw;
    settings.beta = beta;
    settings.initial_lambda = 300.0;
    return P1Case{name, settings};
  };
  std::vector<P1Case> out{make("linear", model::ModelKind::linear),
                          make("corotated", model::ModelKind::corotated),
                          make("warped", model::ModelKind::corotated),
                          make("geometrically_nonlinear", model::ModelKind::geometrically_nonlinear),
                          make("hyperelastic_beta0", model::ModelKind::hyperelastic),
                          make("hyperelastic_beta1", model::ModelKind::hyperelastic, 1.0),
                          make("hyperelastic_beta100", model::ModelKind::hyperelastic, 100.0),
                          make("neo_hookean_beta10", model::ModelKind::hyperelastic, 10.0)};
  out[2].settings.corotated_tangent = model::CorotatedTangent::warped;
  out.back().settings.law.c2 = 0.0;
  return out;
}

struct Evaluated {
  VectorX residual;         ///< (R_u, R_lambda)
  Eigen::MatrixXd tangent;  ///< the whole symmetric saddle matrix
  double energy = 0.0;
  model::Evaluation of_residual, of_tangent;
};

inline Eigen::MatrixXd dense(const linalg::SaddleMatrix& K) {
  const auto n = static_cast<Eigen::Index>(K.displacement_unknowns()),
             m = static_cast<Eigen::Index>(K.pressure_unknowns());
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(n + m, n + m);
  const linalg::BlockPattern& a = *K.A.pattern;
  for (std::int32_t row = 0; row < a.rows(); ++row) {
    for (auto k = static_cast<std::size_t>(a.row_start[static_cast<std::size_t>(row)]);
         k < static_cast<std::size_t>(a.row_start[static_cast<std::size_t>(row) + 1]); ++k) {
      const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> block(&K.A.values[9 * k]);
      out.block<3, 3>(3 * row, 3 * a.column[k]) = block;
      if (a.column[k] != row) out.block<3, 3>(3 * a.column[k], 3 * row) = block.transpose();
    }
  }
  for (std::int32_t row = 0; row < m; ++row) {
    for (auto k = static_cast<std::size_t>(K.B.pattern->row_start[static_cast<std::size_t>(row)]);
         k < static_cast<std::size_t>(K.B.pattern->row_start[static_cast<std::size_t>(row) + 1]); ++k) {
      for (int i = 0; i < 3; ++i) {
        const Eigen::Index dof = 3 * K.B.pattern->column[k] + i;
        out(n + row, dof) = out(dof, n + row) = K.B.values[3 * k + static_cast<std::size_t>(i)];
      }
    }
    for (auto k = static_cast<std::size_t>(K.C.pattern->row_start[static_cast<std::size_t>(row)]);
         k < static_cast<std::size_t>(K.C.pattern->row_start[static_cast<std::size_t>(row) + 1]); ++k) {
      const Eigen::Index col = K.C.pattern->column[k];
      out(n + row, n + col) = out(n + col, n + row) = -K.C.values[k];
    }
  }
  return out;
}

inline Evaluated evaluate(const model::Model& model, const model::State& state) {
  Evaluated out;
  const auto scratch = model.make_scratch();
  model::Residual residual;
  residual.u.resize(state.u.size());
  residual.lambda.resize(state.lambda.size());
  out.of_residual = model.residual(state, *scratch, residual);
  linalg::SaddleMatrix K = model.make_tangent();
  out.of_tangent = model.tangent(state, *scratch, K);
  out.energy = model.energy(state);
  out.residual.resize(state.u.size() + state.lambda.size());
  out.residual << residual.u, residual.lambda;
  out.tangent = dense(K);
  return out;
}

/// As a suite of tests over cases names them.
inline std::string p1_case_name(const testing::TestParamInfo<P1Case>& tested) {
  std::string name = tested.param.name;
  std::replace_if(
      name.begin(), name.end(), [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; }, '_');
  return name;
}

}  // namespace rhexis::test
