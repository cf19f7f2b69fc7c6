#pragma once

/// The linear systems of a body that moves a little from frame to frame: conjugate gradients on S = A + B C^-1 B^T, the
/// pressure eliminated (linalg/condensed_preconditioner.h), cut short, with the preconditioner of live_preconditioner.h
/// turned with the body. Systems that are due at once are solved side by side.

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <tuple>
#include <vector>

#include "base/background.h"
#include "linalg/chebyshev_inverse.h"
#include "linalg/front_solver.h"
#include "linalg/saddle_residual.h"
#include "linalg/side_by_side_cg.h"
#include "linalg/whole_rows.h"
#include "model/model.h"
#include "solver/live_preconditioner.h"
#include "solver/node_rotations.h"

namespace rhexis::solver {

/// A surface point: the first `count` nodes, weights of sum 1.
struct HeldPoint {
  std::array<std::int32_t, 3> node{};
  Vec3 weight = Vec3::Zero();
  int count = 0;

  /// N x.
  template <class Vectors>
  [[nodiscard]] Vec3 of(const Vectors& x, Eigen::Index lane = 0) const {
    Vec3 out = Vec3::Zero();
    for (int k = 0; k < count; ++k)
      out += weight[k] * x.template block<3, 1>(3 * Eigen::Index{node[static_cast<std::size_t>(k)]}, lane);
    return out;
  }
  /// x += N^T f.
  template <class Vectors>
  void add(const Vec3& f, Vectors& x, Eigen::Index lane = 0) const {
    for (int k = 0; k < count; ++k)
      x.template block<3, 1>(3 * Eigen::Index{node[static_cast<std::size_t>(k)]}, lane) += weight[k] * f;
  }
};

/// Iterations of the caller after which a preconditioner that was begun beside him is taken up: by then it is ready,
/// mostly.
inline constexpr int kRefreshWork = 48;

/// `fixed`: with N xu = 0, by projection of the residuals and a preconditioner that knows the constraint (Gould,
/// Hribar, Nocedal 2001); what is left of a residual along N^T is the force that keeps it, and counts as nothing.
enum class Point { free, fixed };

struct LiveOrder {
  Point point = Point::free;
  double tolerance = 0.0;  ///< relative residual, of what there is with the pressures eliminated
  int most = 0;            ///< iterations at most; 0: no system
  /// C^-1 to a percent and not to a third, for several times its price: for a body that is about to give way, whose
  /// tangent is definite by the pressures alone.
  bool careful = false;
};

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
  /// The same at displacements u.
  void measure(const VectorX& u, std::vector<Mat3>& out) const { rotations_.measure(u, out); }
  /// N of the solves that are to leave N x = 0: the displacement of the point. Empty: there is none.
  void set_constraint(const std::optional<HeldPoint>& point);
  /// P~^-1 N^T with the pressures that go with it, by columns: a first answer to the hand, positive definite whatever
  /// the tangent is.
  void first_answer(linalg::FourLanes& xu, linalg::FourLanes& xp);
  /// K (xu, xp) ~ (bu, bp) over the free dofs.
  LiveSolve solve(const LiveOrder& order, const VectorX& bu, const VectorX& bp, VectorX& xu, VectorX& xp);
  /// Side by side, k = 1, 2 or 4: a system to a lane; those without one come out zero. One that is careful makes all
  /// so.
  template <int k>
  std::array<LiveSolve, k> solve(const std::array<LiveOrder, k>& orders, const linalg::Lanes<k>& bu,
                                 const linalg::Lanes<k>& bp, linalg::Lanes<k>& xu, linalg::Lanes<k>& xp);
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
  /// What a solve of k lanes works with.
  template <int k>
  struct Work {
    linalg::Lanes<k> r, turned, solved;  // dofs
    linalg::Lanes<k> p, q, left, more;   // pressures: C^-1 of q; what a careful inverse leaves
    linalg::CgLanes<k> cg;
    std::array<bool, k> fixed{};
  };
  template <int k>
  void invert_pressure(const linalg::Lanes<k>& b, bool careful, Work<k>& work, linalg::Lanes<k>& x);
  template <int k>
  void apply(const linalg::Lanes<k>& x, bool careful, Work<k>& work, linalg::Lanes<k>& y);
  template <int k>
  void precondition(const linalg::Lanes<k>& r, Work<k>& work, linalg::Lanes<k>& z);
  template <int k>
  void project(const Work<k>& work, linalg::Lanes<k>& r) const;
  void solve_for_point();
  void turn();

  std::shared_ptr<const model::Model> model_;
  linalg::FreeDofs free_;
  double inertia_;
  linalg::ChebyshevInverse c_inverse_;
  const linalg::SaddleMatrix* K_ = nullptr;
  linalg::WholeRows A_;  ///< of it
  LivePreconditioner::Shared preconditioner_;

  NodeRotations rotations_;
  std::vector<Mat3> rotation_;  ///< of each node at the tangent
  std::vector<Mat3> turn_;      ///< T, since the preconditioner's state

  std::optional<HeldPoint> point_;
  std::vector<linalg::FourLanes> of_nodes_;  ///< P~^-1 of the dofs of each of the point's nodes, as it lies
  linalg::FourLanes answer_;                 ///< P~^-1 N^T by columns, turned
  Mat3 answer_inverse_ = Mat3::Zero();       ///< (N P~^-1 N^T)^-1
  std::tuple<Work<1>, Work<2>, Work<4>> work_;
  linalg::ChebyshevInverse::Work c_work_;
  linalg::FrontSolver::Work front_work_;

  int worked_ = 0;           ///< iterations since the refresh began
  TornModel torn_since_;     ///< the same for the body
  model::State state_then_;  ///< where it has torn since: its state after the last time
  LivePreconditioner::Shared refreshed_;
  std::atomic<bool> ready_ = false;
  BackgroundTask task_;  ///< writes the two above: it has to end before they do, so it stands last
};

}  // namespace rhexis::solver
