#pragma once

/// Equilibrium that keeps up with a hand (section 6.3 of the paper): a state that is warm from the frame before, a few
/// Newton corrections a frame, a factor that is kept while it pays.
///
/// The hand moves one point, sum of w_i u_i = N u = d, by the force f that this takes:
///
///     R(u, lambda) - t F - N^T f = 0,   N u = d.
///
/// Z = K^-1 N^T, the answer of the last tangent to the hand, is kept. It gives the compliance C = N Z that serves the
/// haptic loop between frames, a first guess of the next state for nothing (u + Z C^-1 (d - N u)), and the force of a
/// state that has not converged, right to second order in what is left of the residual: f + C^-1 Z^T r.
///
/// A body with mass is in equilibrium with its inertia too (solver/inertia.h): the frames between two `begin_step`
/// bring it to the end of one time step, and the next one begins only from there. A step that takes more frames is
/// late, and adds no energy.

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <string>

#include "model/loading.h"
#include "model/model.h"
#include "solver/inertia.h"
#include "solver/live_linear.h"
#include "solver/point_answer.h"

namespace rhexis::solver {

struct LiveOptions {
  int corrections = 1;       ///< Newton corrections a frame at most
  double tolerance = 1e-4;   ///< relative residual below which a frame needs no (further) correction
  double at_rest = 1e-7;     ///< the same where nothing is held and there is no haste, if it is the smaller
  double forcing = 0.3;      ///< relative residual of the linear solve of a correction
  int iterations = 5;        ///< of conjugate gradients in it, at most
  double late = 0.1;         ///< relative residual above which the hand is not followed further: late, not wrong
  double worn_answer = 0.2;  ///< relative residual above which a column of Z is solved for again, one a frame
};

struct LiveFrame {
  bool reached = true;  ///< false: the point is not yet where the hand is
  int corrections = 0;
  int linear_iterations = 0;
  double residual = 0.0;   ///< relative to internal and external force, after the frame
  bool refreshed = false;  ///< a preconditioner that was made in the background was taken up
  bool gave_up = false;    ///< it did not come nearer to equilibrium for long, and is back where it was near last, with
                           ///< mass without motion; or, without a hand, no correction brings it nearer
  std::string trouble;     ///< one line, empty when there was none
};

/// Of a body that moves a frame may end a time step, which takes more of it than to follow a hand does: the options,
/// with as many corrections and iterations at the least, and as small a `forcing` at the most, as that needs.
[[nodiscard]] LiveOptions moving(LiveOptions options);

class LiveEquilibrium {
 public:
  /// `loading` counts at t = 1. Starts from `state`, with the supports where they are to be. With `dynamics` it has
  /// mass, and starts at rest.
  LiveEquilibrium(std::shared_ptr<const model::Model> model, model::Loading loading, model::State state,
                  LiveOptions options, const std::optional<Dynamics>& dynamics = std::nullopt);

  /// The body has torn: another model and loading of it, of the same tets and more nodes, that starts from `state`,
  /// which has to be admissible. What the hand holds it goes on holding; the caller lets go what has come off.
  void follow(std::shared_ptr<const model::Model> model, model::Loading loading, model::State state,
              const TornModel& torn);

  /// The hand takes hold; its displacement counts from the reference position of the point. No node of it may be held
  /// by a support: RHEXIS_CHECK.
  void hold(const HeldPoint& point);
  void let_go();
  [[nodiscard]] bool holds() const { return held_.has_value(); }

  /// One frame: the point to `hand` (m), then corrections. Never hands out a force that is not finite, or a state with
  /// an inverted tet where the law has no answer there: it stays where it was instead, and says so.
  LiveFrame step(const Vec3& hand);
  /// One frame without a hand.
  LiveFrame settle();

  /// The next time step of a body with mass begins. False: the one under way has not ended yet, and goes on.
  bool begin_step();
  /// It would go on moving: `at_rest` and `tolerance` say what counts as none.
  [[nodiscard]] bool moves() const;
  /// Of a body with mass: RHEXIS_CHECK.
  [[nodiscard]] const Inertia& inertia() const;
  /// Goes on as a body of this state once did.
  void set_motion(Motion motion);

  [[nodiscard]] const model::State& state() const { return state_; }
  [[nodiscard]] const model::Loading& loading() const { return loading_; }
  /// Of the residual to the forces, as LiveFrame has it.
  [[nodiscard]] double residual() const { return now_.relative; }
  [[nodiscard]] int inverted_tets() const { return now_.evaluation.inverted_tets; }
  [[nodiscard]] std::size_t memory_bytes() const { return linear_.memory_bytes() + model_->memory_bytes(); }
  /// Displacement of the held point, m.
  [[nodiscard]] Vec3 point() const;
  /// Of the hand on the body, N, right to second order.
  [[nodiscard]] Vec3 force() const { return scale() * force_; }
  /// Of the point at the last tangent, m/N, symmetric; with mass within a time step.
  [[nodiscard]] Mat3 compliance() const { return compliance_ / scale(); }
  /// Its inverse, N/m: between frames the hand at d feels force() + stiffness() (d - point()).
  [[nodiscard]] Mat3 stiffness() const { return scale() * stiffness_; }
  /// Of a body with mass that is held, in the time step under way: the velocity of the point, m/s, and how fast the
  /// internal force at it grows, N/s. So both go on where every node does as in this step.
  [[nodiscard]] Vec3 velocity() const;
  [[nodiscard]] Vec3 force_rate() const;

 private:
  struct Trial {
    model::Evaluation evaluation;
    double norm = 0.0;  ///< N, of the residual on the free dofs
    double relative = 0.0;
    double scale = 0.0;  ///< N, that it is relative to
  };
  [[nodiscard]] double scale() const { return inertia_ ? inertia_->scale() : 1.0; }
  [[nodiscard]] double wanted_residual() const {
    return held_ ? options_.tolerance : std::min(options_.tolerance, options_.at_rest);
  }
  void make_room();
  LiveFrame advance(const Vec3* hand);
  void guess(const Vec3& gap);
  bool follow(const Vec3& hand, LiveFrame& frame);
  bool correct(LiveFrame& frame);
  bool take_correction(bool downhill_only);
  [[nodiscard]] double stored_energy(const model::State& state);
  void keep_good(LiveFrame& frame);
  /// Leaves the residual in residual_ and the hand's force that makes it least in multiplier_.
  Trial evaluate(const model::State& state);
  [[nodiscard]] bool is_admissible(const Trial& trial) const;
  void build_tangent();
  /// Brings Z to a relative residual; gives the iterations that it took.
  int refresh_answer(double tolerance, int most);
  LiveSolve solve_correction(int most, bool careful, LiveFrame& frame);
  void update_compliance();
  void correct_force();

  std::shared_ptr<const model::Model> model_;
  model::Loading loading_;
  LiveOptions options_;
  linalg::FreeDofs free_;
  std::unique_ptr<model::Scratch> scratch_;
  model::State state_;
  std::optional<Inertia> inertia_;
  linalg::SaddleMatrix tangent_;
  LiveLinear linear_;

  Vec3 multiplier_ = Vec3::Zero();  ///< N, that goes with the state
  Vec3 force_ = Vec3::Zero();
  Trial now_;
  model::Residual residual_;     ///< without the hand's force
  VectorX external_, internal_;  ///< N

  std::optional<HeldPoint> held_;
  PointAnswer answer_;   ///< Z
  int next_column_ = 0;  ///< of it, that a correction brings along
  Mat3 compliance_ = Mat3::Zero();
  Mat3 stiffness_ = Mat3::Zero();
  Mat3 from_gap_ = Mat3::Zero();  ///< (N Z)^-1

  model::State trial_;
  std::vector<Mat3> half_way_;   ///< rotations of the nodes in the middle of a move
  model::State good_;            ///< the last one near to equilibrium, of a body with mass of the step under way
  double least_ = 0.0;           ///< N, residual of the frames since it was late, or a time step began, the least
  int idle_frames_ = 0;          ///< such frames in a row that have not lessened it
  bool cautious_ = false;        ///< since it gave up: no step that lets the residual grow
  bool worn_ = false;            ///< the frame has found the preconditioner wanting
  int iterations_when_new_ = 0;  ///< of the first correction with it; 0: there was none
  bool begun_ = false;           ///< a time step, since the last frame
  double size_of_body_ = 0.0;    ///< m
  double small_force_ = 0.0;     ///< N, the least since it took hold
  VectorX du_, dlambda_, rhs_u_, rhs_lambda_;
};

}  // namespace rhexis::solver
