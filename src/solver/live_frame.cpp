// One frame of LiveEquilibrium: the move of the hand, corrections, and what to do where they fail.

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "base/check.h"
#include "base/parallel.h"
#include "solver/live_equilibrium.h"

namespace rhexis::solver {
namespace {

/// A move of the hand is halved this often at most where a tet would invert.
constexpr int kHalvings = 4;
/// A correction that leaves more than this times the residual is not taken. Moves out of bending stretch first.
constexpr double kGrowth = 4.0;
/// Of worn_answer: the residual to which Z is solved for where the hand stands still.
constexpr double kStillAnswer = 0.2;
/// Of a step that is to lessen the energy.
constexpr int kEnergyHalvings = 12;
/// Frames in a row that are late, or do not end a time step, and do not lessen the residual by kProgress, after which
/// the state is given up.
constexpr int kMostIdleFrames = 20;
constexpr double kProgress = 0.9;
/// Corrections of a frame that is still late after its first one, with that, and how much further each is solved.
constexpr int kLateCorrections = 2;
constexpr int kLateIterations = 3;
/// Iterations from which on a preconditioner is made anew at the present state; of a body in a hand that is in time so
/// many more than when it was new, since the making takes a core.
constexpr int kWornIterations = 4;
constexpr int kWornMore = 2;

}  // namespace

LiveFrame LiveEquilibrium::step(const Vec3& hand) {
  RHEXIS_CHECK(holds(), "no point is held");
  return advance(&hand);
}
LiveFrame LiveEquilibrium::settle() {
  RHEXIS_CHECK(!holds(), "a point is held");
  return advance(nullptr);
}

/// f + C^-1 Z^T r, r the residual of the state with its multiplier; f alone while Z is none, where the tangent has no
/// answer.
void LiveEquilibrium::correct_force() {
  const Vec3 corrected = multiplier_ + stiffness_ * answer_.dot(residual_);
  force_ = corrected.allFinite() ? corrected : multiplier_;
}

/// The last tangent's answer to a move of the hand, in trial_. By the chord it is Z C^-1 gap; a body that bends moves
/// along arcs, and the chord of an arc has the direction of its middle: so Z is taken as the body will have turned half
/// way. What a straight step stretches a body by that only turns is kappa / mu times as much in its forces. Not of laws
/// that let tets turn inside out: they give way where they are pressed, and without that stretch a fast hand loses them
/// there (docs/performance.md).
void LiveEquilibrium::guess(const Vec3& gap) {
  trial_ = state_;
  answer_.add(from_gap_ * gap, trial_);
  if (model_->allows_inversion()) return;
  trial_.u = 0.5 * (state_.u + trial_.u);
  linear_.measure(trial_.u, half_way_);
  trial_ = state_;
  answer_.add_turned(half_way_, gap, free_, trial_);
}

/// The first guess, shortened where a tet would invert. False: there is none.
bool LiveEquilibrium::follow(const Vec3& hand, LiveFrame& frame) {
  const Vec3 gap = hand - held_->of(state_.u);
  Trial next;
  for (int halving = 0; halving <= kHalvings; ++halving) {
    guess(std::ldexp(1.0, -halving) * gap);
    next = evaluate(trial_);
    if (!is_admissible(next)) continue;
    frame.reached = halving == 0;
    std::swap(state_, trial_);
    now_ = next;
    return true;
  }
  frame.reached = false;
  frame.trouble =
      next.evaluation.worst_tet.valid()
          ? fmt::format("the body cannot follow: tet {} would turn inside out", next.evaluation.worst_tet.value())
          : "the body cannot follow: its forces would be no finite numbers";
  now_ = evaluate(state_);
  return false;
}

/// For (du, dlambda), with the point where it is; the first one of a frame brings a column of Z along.
LiveSolve LiveEquilibrium::solve_correction(int most, bool careful, LiveFrame& frame) {
  rhs_u_ = -residual_.u;
  rhs_lambda_ = -residual_.lambda;
  const LiveOrder order{.point = Point::fixed, .tolerance = options_.forcing, .most = most, .careful = careful};
  if (held_ && frame.linear_iterations == 0) {
    PointAnswer::Beside beside{order, rhs_u_, rhs_lambda_, du_, dlambda_, {}};
    const PointAnswer::Report report =
        answer_.refresh(next_column_, tangent_, free_, linear_,
                        {.residual = options_.worn_answer, .iterations = options_.iterations}, beside);
    next_column_ = (next_column_ + 1) % 3;
    worn_ = worn_ || report.worn;
    frame.linear_iterations = report.iterations;
    return beside.solve;
  }
  const LiveSolve solve = linear_.solve(order, rhs_u_, rhs_lambda_, du_, dlambda_);
  frame.linear_iterations += solve.iterations;
  return solve;
}

/// One Newton correction that leaves the point where it is. False: none was taken.
bool LiveEquilibrium::correct(LiveFrame& frame) {
  build_tangent();
  if (held_) answer_.turn(linear_, free_);
  const int most = (now_.relative > options_.late ? kLateIterations : 1) * options_.iterations;
  for (const bool careful : {false, true}) {
    const LiveSolve solve = solve_correction(most, careful, frame);
    if (iterations_when_new_ == 0) iterations_when_new_ = std::max(1, solve.iterations);
    const bool has_haste = inertia_ || (held_ && now_.relative <= options_.late);
    const int worn_from = has_haste ? iterations_when_new_ + kWornMore : kWornIterations;
    worn_ = worn_ || solve.iterations >= worn_from || solve.truncated;
    if (take_correction(solve.truncated)) {
      ++frame.corrections;
      return true;
    }
    now_ = evaluate(state_);
  }
  frame.trouble = "a correction would make it worse";
  return false;
}

/// As far along (du, dlambda) as the residual does not grow, or as the energy falls, which it can where the residual
/// has a valley of its own: a body that snaps through. False: neither.
bool LiveEquilibrium::take_correction(bool downhill_only) {
  const auto try_part = [&](int halving) {
    const double part = std::ldexp(1.0, -halving);
    trial_.u = state_.u + part * du_;
    trial_.lambda = state_.lambda + part * dlambda_;
    return evaluate(trial_);
  };
  const auto take = [&](const Trial& next) {
    std::swap(state_, trial_);
    now_ = next;
    return true;
  };
  for (int halving = 0; !downhill_only && halving <= kHalvings; ++halving) {
    const Trial next = try_part(halving);
    if (is_admissible(next) && next.norm <= (cautious_ ? 1.0 : kGrowth) * now_.norm) return take(next);
  }
  now_ = evaluate(state_);
  const double energy = stored_energy(state_);
  const VectorX load = external_;
  for (int halving = 0; halving <= kEnergyHalvings; ++halving) {
    const Trial next = try_part(halving);
    if (!is_admissible(next) || next.norm > kGrowth * now_.norm) continue;
    // Of loads that follow the surface by the trapezium.
    const double work = 0.5 * (load + external_).dot(trial_.u - state_.u);
    if (stored_energy(trial_) - work < energy) {
      idle_frames_ = 0;  // it goes on, whatever the residual says
      return take(next);
    }
  }
  return false;
}

/// J, of the state that was evaluated last, with the pressures where they make it greatest: the energy is quadratic in
/// them, so Pi + r^T C^-1 r / 2, r their residual.
double LiveEquilibrium::stored_energy(const model::State& state) {
  return model_->energy(state) + linear_.energy_of_pressure(residual_.lambda);
}

/// A state that does not find back is given up for the last one that was near to equilibrium, or from which it set out;
/// and so is the motion of a body whose time step does not end. That goes back to where its step began at the most.
void LiveEquilibrium::keep_good(LiveFrame& frame) {
  if (now_.relative <= options_.late) {
    good_ = state_;
    cautious_ = false;
  }
  if (now_.relative <= (inertia_ ? options_.tolerance : options_.late)) {
    idle_frames_ = 0;
    return;
  }
  if (idle_frames_ == 0 || now_.norm < kProgress * least_) {
    least_ = now_.norm;
    idle_frames_ = 1;
  } else if (++idle_frames_ > kMostIdleFrames) {
    state_ = good_;
    now_ = evaluate(state_);
    if (inertia_) {
      inertia_->halt(state_.u, internal_);
      now_ = evaluate(state_);
    }
    idle_frames_ = 0;
    cautious_ = !cautious_;
    worn_ = frame.gave_up = true;
    frame.trouble = inertia_ ? "a time step does not end: the motion is taken out of the body"
                             : "no equilibrium near: back to the last one";
  }
}

LiveFrame LiveEquilibrium::advance(const Vec3* hand) {
  LiveFrame frame;
  worn_ = false;
  frame.refreshed = linear_.take_refreshed();
  if (frame.refreshed) iterations_when_new_ = 0;
  std::optional<OneThreadHere> beside;  // the refresh, which has a core of its own
  if (linear_.is_refreshing()) beside.emplace();
  frame.reached = hand == nullptr || now_.relative <= options_.late || begun_;
  begun_ = false;
  const bool stays = hand != nullptr && frame.reached && !follow(*hand, frame);
  if (stays && !inertia_) {  // the step of a body with mass goes on all the same
    frame.residual = now_.relative;
    return frame;
  }
  const auto most = [&] {
    return now_.relative > options_.late ? std::max(kLateCorrections, options_.corrections) : options_.corrections;
  };
  while (frame.corrections < most() && now_.relative > wanted_residual()) {
    if (correct(frame)) continue;
    frame.gave_up = !held_ && frame.corrections == 0;  // nothing else will move it
    break;
  }
  if (held_) {
    if (frame.corrections == 0)  // there is time to bring Z further
      frame.linear_iterations += refresh_answer(kStillAnswer * options_.worn_answer, options_.iterations);
    update_compliance();
  }
  keep_good(frame);
  if (held_) correct_force();
  if (worn_) linear_.refresh(state_);
  frame.residual = now_.relative;
  return frame;
}

}  // namespace rhexis::solver
