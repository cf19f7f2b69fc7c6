#pragma once

/// The linear systems of a body that moves a little from frame to frame: conjugate gradients on S = A + B C^-1 B^T, the
/// pressure eliminated (linalg/condensed_preconditioner.h), cut short. What makes them cheap is the preconditioner
///
///     P~ = sum over tets of (A_e + b_e b_e^T / d_e) + V G^-1 V^T,
///
/// whose sum is factored by a FrontTree: a version that never changes, which another thread may make anew meanwhile,
/// and which follows a crack by factoring again what the crack has touched. No BLAS, no workspace that two threads
/// share.

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "base/background.h"
#include "linalg/chebyshev_inverse.h"
#include "linalg/conjugate_gradients.h"
#include "linalg/front_solver.h"
#include "linalg/front_tree.h"
#include "linalg/pressure_patches.h"
#include "linalg/saddle_residual.h"
#include "model/model.h"
#include "solver/node_rotations.h"

namespace rhexis::solver {

/// A surface point: the first `count` nodes, weights of sum 1.
struct HeldPoint {
  std::array<std::int32_t, 3> node{};
  Vec3 weight = Vec3::Zero();
  int count = 0;

  /// N x.
  [[nodiscard]] Vec3 of(const VectorX& x) const {
    Vec3 out = Vec3::Zero();
    for (int k = 0; k < count; ++k)
      out += weight[k] * x.segment<3>(3 * Eigen::Index{node[static_cast<std::size_t>(k)]});
    return out;
  }
  /// x += N^T f.
  void add(const Vec3& f, VectorX& x) const {
    for (int k = 0; k < count; ++k) x.segment<3>(3 * Eigen::Index{node[static_cast<std::size_t>(k)]}) += weight[k] * f;
  }
};

/// What a tear did to a model that follows it.
struct TornModel {
  std::vector<std::int32_t> copied;   ///< the node that each appended node is a copy of
  std::vector<std::int32_t> touched;  ///< tets that went, moved or took other nodes; ascending

  /// Another one after it.
  void add(const TornModel& next);
};

/// Iterations of the caller after which a preconditioner that was begun beside him is taken up: by then it is ready,
/// mostly.
inline constexpr int kRefreshWork = 60;

struct LiveSolve {
  int iterations = 0;
  /// A direction of negative curvature was met. An answer with the point fixed goes on along it (Steihaug 1983), which
  /// is downhill in energy and may be uphill in the residual; one with it free is what there was before it.
  bool truncated = false;
};

class LiveLinear {
 public:
  /// Prepares the preconditioner at `state`. `inertia`: what the mass of the tangent adds per volume, N/m^4.
  LiveLinear(std::shared_ptr<const model::Model> model, linalg::FreeDofs free, const model::State& state,
             double inertia = 0.0);
  ~LiveLinear();

  /// The body has torn: another model of it, of the same tets and more nodes, at `state`. The preconditioner follows
  /// what was touched, and so will one that is under way. Tangent and constraint have to be set again.
  void follow(std::shared_ptr<const model::Model> model, linalg::FreeDofs free, const model::State& state,
              const TornModel& torn);

  /// The matrix of the solves that follow, the tangent at `state`; stays with the caller. The preconditioner turns with
  /// the body.
  void set_tangent(const linalg::SaddleMatrix& K, const model::State& state);
  /// Per node, how far it had turned at the last tangent.
  [[nodiscard]] const std::vector<Mat3>& rotation() const { return rotation_; }
  /// N of the solves that are to leave N x = 0: the displacement of the point. Empty: there is none.
  void set_constraint(const std::optional<HeldPoint>& point);
  /// P~^-1 N^T e_j with the pressures that go with it: a first answer to the hand, positive definite over the j
  /// whatever the tangent is.
  void first_answer(int j, VectorX& xu, VectorX& xp);
  /// K (xu, xp) ~ (bu, bp) over the free dofs to a relative residual of `tolerance`, at most `most` iterations.
  /// `fixed`: with N xu = 0, by projection of the residuals and a preconditioner that knows the constraint (Gould,
  /// Hribar, Nocedal 2001); what is left of a residual along N^T is the force that keeps it, and counts as nothing.
  enum class Point { free, fixed };
  /// `careful`: with C^-1 to a percent and not to a third, for several times its price: for a body that is about to
  /// give way, whose tangent is definite by the pressures alone.
  LiveSolve solve(Point point, const VectorX& bu, const VectorX& bp, double tolerance, int most, bool careful,
                  VectorX& xu, VectorX& xp);
  /// r^T C^-1 r / 2, J: what the stored energy has to gain by the pressures, from their residual r.
  [[nodiscard]] double energy_of_pressure(const VectorX& rp);
  /// Starts to prepare another preconditioner at `state` beside the caller, unless one is under way.
  void refresh(const model::State& state);
  /// Takes it up when it is due, that is after kRefreshWork iterations, and waits for it then: a count and no clock, so
  /// that the same input gives the same bits. True: it was.
  bool take_refreshed();
  [[nodiscard]] bool is_refreshing() const { return task_.under_way() && !ready_; }
  [[nodiscard]] std::size_t memory_bytes() const;

 private:
  struct Preconditioner;
  using Prepared = std::shared_ptr<const Preconditioner>;
  /// `before`: one of the same tets, whose order is taken and, where it is of the same model, what depends on C alone;
  /// null: none.
  [[nodiscard]] static Prepared prepare(const std::shared_ptr<const model::Model>& model, const linalg::FreeDofs& free,
                                        const model::State& state, double inertia, const Preconditioner* before);
  /// After the body has torn, at a state of the present model. Null: it would not be definite.
  [[nodiscard]] Prepared followed(const Preconditioner& before, const model::State& state, const TornModel& torn) const;
  void invert_pressure(const VectorX& b, VectorX& x, bool careful);
  void apply(const VectorX& x, VectorX& y);
  void precondition(const VectorX& r, VectorX& z);
  void project(VectorX& r) const;
  void solve_for_point();
  void turn();

  std::shared_ptr<const model::Model> model_;
  linalg::FreeDofs free_;
  double inertia_;
  linalg::ChebyshevInverse c_inverse_;
  const linalg::SaddleMatrix* K_ = nullptr;
  Prepared preconditioner_;

  NodeRotations rotations_;
  std::vector<Mat3> rotation_;  ///< of each node at the tangent
  std::vector<Mat3> turn_;      ///< T, since the preconditioner's state
  VectorX turned_, solved_;

  bool careful_ = false;      ///< the solve under way
  bool constrained_ = false;  ///< and that
  std::optional<HeldPoint> point_;
  std::vector<VectorX> of_nodes_;       ///< P~^-1 of each dof of the point's nodes, as the preconditioner lies
  std::array<VectorX, 3> answer_;       ///< P~^-1 N^T, turned
  Mat3 answer_inverse_ = Mat3::Zero();  ///< (N P~^-1 N^T)^-1
  linalg::CgWorkspace work_;
  VectorX r_, p_, q_;
  VectorX left_, more_;  ///< of a careful inverse
  linalg::ChebyshevInverse::Work c_work_;
  linalg::FrontSolver::Work front_work_;

  int worked_ = 0;           ///< iterations since the refresh began
  TornModel torn_since_;     ///< the same for the body
  model::State state_then_;  ///< where it has torn since: its state after the last time
  Prepared refreshed_;
  std::atomic<bool> ready_ = false;
  BackgroundTask task_;  ///< writes the two above: it has to end before they do, so it stands last
};

}  // namespace rhexis::solver
