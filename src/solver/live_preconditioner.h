#pragma once

/// What makes the linear systems of a live body cheap: a factor of
///
///     P~ = sum over tets of (A_e + b_e b_e^T / d_e) + V G^-1 V^T
///
/// at some state (linalg/pressure_patches.h), in single precision. It never changes once made: another thread may make
/// the next one meanwhile, and it follows a crack by factoring again what the crack has touched. No BLAS, no workspace
/// that two threads share.

#include <cstdint>
#include <memory>
#include <vector>

#include "linalg/front_solver.h"
#include "linalg/front_tree.h"
#include "linalg/pressure_patches.h"
#include "model/model.h"
#include "solver/node_rotations.h"
#include "solver/tet_tangents.h"

namespace rhexis::solver {

/// What a tear did to a model that follows it.
struct TornModel {
  std::vector<std::int32_t> copied;   ///< the node that each appended node is a copy of
  std::vector<std::int32_t> touched;  ///< tets that went, moved or took other nodes; ascending

  /// Another one after it.
  void add(const TornModel& next);
};

class LivePreconditioner {
 public:
  using Shared = std::shared_ptr<const LivePreconditioner>;
  /// At `state`. `inertia`: what the mass of the tangent adds per volume, N/m^4. `before`: one of the same tets, whose
  /// order is taken and, where it is of the same model, what depends on C alone; null: none.
  [[nodiscard]] static Shared make(const std::shared_ptr<const model::Model>& model, const linalg::FreeDofs& free,
                                   const model::State& state, double inertia, const LivePreconditioner* before);
  /// After the body has torn, at a state of its present model, whose rotations those are. Null: it would not be
  /// definite.
  [[nodiscard]] Shared followed(const model::Model& model, const linalg::FreeDofs& free, const model::State& state,
                                const NodeRotations& rotations, const TornModel& torn) const;

  /// z = P~^-1 r, as it lies.
  template <class Vectors>
  void solve(const Vectors& r, Vectors& z, linalg::FrontSolver::Work& work) const {
    solver_->solve(r, z, work);
    patches_.apply(r, z);
  }
  /// Of each node, at its state.
  [[nodiscard]] const std::vector<Mat3>& rotation() const { return rotation_; }
  [[nodiscard]] std::size_t memory_bytes() const;

 private:
  LivePreconditioner(std::shared_ptr<const model::Model> model, TetTangents tets)
      : model_(std::move(model)), tets_(std::move(tets)) {}

  std::shared_ptr<const model::Model> model_;  ///< whose C it knows
  TetTangents tets_;
  std::shared_ptr<const linalg::FrontTree> tree_;
  std::shared_ptr<const linalg::FrontSolver> solver_;  ///< of the tree
  linalg::PressurePatches patches_;
  std::vector<Mat3> rotation_;
};

}  // namespace rhexis::solver
