#pragma once

/// A torn body of large strain solved the slow obvious way: the tets in the solve alone, as a mesh of their own, loaded
/// in steps from rest or from a state near by, to the tolerance of a solve.

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <vector>

#include <Eigen/Cholesky>

#include "response/torn_model.h"
#include "solver/equilibrium.h"

namespace rhexis::test {

class FullSolve {
 public:
  FullSolve(const mesh::TornMesh& mesh, const response::LiveBody& body, const VectorX& u) {
    mesh_.nodes = mesh.mesh().nodes;
    for (std::size_t t = 0; t < mesh.mesh().tet_count(); ++t) {
      if (!mesh.is_solved(TetId(t))) continue;
      mesh_.tets.push_back(mesh.mesh().tets[t]);
      tet_.push_back(static_cast<Eigen::Index>(t));
    }
    model_ = model::make_model(mesh_, body.model);
    loading_ = response::make_torn_loading(mesh, body, model_->space(), u);
  }

  /// Of the torn body's state, whose lambdas are per tet of all of it.
  [[nodiscard]] model::State state_of(const model::State& torn) const {
    model::State out{torn.u, VectorX(model_->pressure_unknowns())};
    for (Eigen::Index t = 0; t < out.lambda.size(); ++t) out.lambda[t] = torn.lambda[tet_[static_cast<std::size_t>(t)]];
    return out;
  }
  [[nodiscard]] model::State at_rest() const { return model_->initial_state(); }
  /// With the lambdas that go with these displacements, C lambda = g(u).
  [[nodiscard]] model::State state_at(const VectorX& u) const {
    model::State out{u, VectorX::Zero(model_->pressure_unknowns())};
    if (out.lambda.size() == 0) return out;
    const auto scratch = model_->make_scratch();
    linalg::SaddleMatrix K = model_->make_tangent();
    model::Residual residual{VectorX::Zero(u.size()), out.lambda};
    model_->residual(out, *scratch, residual);
    model_->tangent(out, *scratch, K);
    Eigen::MatrixXd C(out.lambda.size(), out.lambda.size());
    VectorX column(out.lambda.size());
    for (Eigen::Index j = 0; j < C.cols(); ++j) {
      K.C.multiply(VectorX::Unit(C.cols(), j), column);
      C.col(j) = column;
    }
    out.lambda = C.llt().solve(residual.lambda);
    return out;
  }

  struct Held {
    model::State state;
    Vec3 force = Vec3::Zero();  ///< N, of the hand on the body
    bool converged = false;
    bool stable = false;  ///< no direction in which the energy falls
  };
  /// With a node at `hand` (m), from `near` in one step, or from rest in ten.
  [[nodiscard]] Held held(NodeId node, const Vec3& hand, model::State near, int steps = 1) const {
    model::Loading loading = loading_;
    for (std::int32_t c = 0; c < 3; ++c) loading.supports.push_back({3 * node.value() + c, hand[c]});
    std::sort(loading.supports.begin(), loading.supports.end(),
              [](const auto& a, const auto& b) { return a.dof < b.dof; });
    Held out;
    const solver::Report report = solve(loading, near, steps);
    out.converged = report.converged();
    out.stable = report.negative_pivots == 0;
    out.force = report.reaction.segment<3>(3 * Eigen::Index{node.value()});
    out.state = std::move(near);
    return out;
  }
  /// Without a hand.
  [[nodiscard]] Held released(model::State near, int steps = 1) const {
    Held out;
    const solver::Report report = solve(loading_, near, steps);
    out.converged = report.converged();
    out.stable = report.negative_pivots == 0;
    out.state = std::move(near);
    return out;
  }
  [[nodiscard]] const model::Model& model() const { return *model_; }

 private:
  solver::Report solve(const model::Loading& loading, model::State& state, int steps) const {
    solver::Options options;
    options.steps = steps;
    options.tolerance = 1e-9;
    return solver::solve_equilibrium(*model_, loading, options, state);
  }

  mesh::TetMesh mesh_;
  std::vector<Eigen::Index> tet_;  ///< of the torn body
  std::unique_ptr<const model::Model> model_;
  model::Loading loading_;
};

}  // namespace rhexis::test
