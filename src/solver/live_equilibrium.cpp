#include "solver/live_equilibrium.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include "base/check.h"
#include "base/parallel.h"

namespace rhexis::solver {
namespace {

/// A move of the hand is halved this often at most where a tet would invert.
constexpr int kHalvings = 4;
/// A correction that leaves more than this times the residual is not taken. Moves out of bending stretch first.
constexpr double kGrowth = 4.0;
/// Of worn_answer: the residual to which Z is solved for when the hand takes hold, and where it stands still, which it
/// mostly does at first; in so many iterations at most: a body that is taken hold of while it comes back from far has a
/// preconditioner that is worn.
constexpr double kFirstAnswer = 0.5;
constexpr double kStillAnswer = 0.2;
constexpr int kMostFirstIterations = 24;
/// Of the body's size: what takes less force to move the hand by is near to rest, and a residual is held against that.
constexpr double kSmallMove = 0.01;
/// Of a step that is to lessen the energy.
constexpr int kEnergyHalvings = 12;
/// Frames in a row that are late, or do not end a time step, and do not lessen the residual by kProgress, after which
/// the state is given up.
constexpr int kMostIdleFrames = 20;
constexpr double kProgress = 0.9;
/// Corrections of a frame that is late after the first one, and how much further each is solved.
constexpr int kLateCorrections = 2;
constexpr int kLateIterations = 3;
/// Iterations from which on a preconditioner is made anew at the present state; of a body in a hand that is in time so
/// many more than when it was new, since the making takes a core.
constexpr int kWornIterations = 4;
constexpr int kWornMore = 2;
/// Of the body's size: of a body with mass the residual is held against the force that moves it so far in a step.
constexpr double kSmallStep = 1e-3;

}  // namespace

LiveOptions moving(LiveOptions options) {
  options.corrections = std::max(options.corrections, 4);
  options.forcing = std::min(options.forcing, 0.02);
  options.iterations = std::max(options.iterations, 20);
  return options;
}

LiveEquilibrium::LiveEquilibrium(std::shared_ptr<const model::Model> model, model::Loading loading, model::State state,
                                 LiveOptions options, const std::optional<Dynamics>& dynamics)
    : model_(std::move(model)),
      loading_(std::move(loading)),
      options_(options),
      free_(model::free_dofs(model_->space(), loading_)),
      state_(std::move(state)),
      inertia_(dynamics ? std::optional<Inertia>(std::in_place, *dynamics, *model_, state_.u) : std::nullopt),
      linear_(model_, free_, state_, dynamics ? dynamics->density * inertia_->per_mass() : 0.0) {
  Eigen::AlignedBox3d box;
  for (const Vec3& x : model_->space().nodes) box.extend(x);
  size_of_body_ = box.diagonal().norm();
  make_room();
}

void LiveEquilibrium::make_room() {
  scratch_ = model_->make_scratch();
  tangent_ = model_->make_tangent();
  const auto dofs = static_cast<Eigen::Index>(model_->space().dof_count());
  const auto pressures = static_cast<Eigen::Index>(model_->pressure_unknowns());
  for (VectorX* vector : {&residual_.u, &external_, &internal_, &du_, &rhs_u_}) vector->setZero(dofs);
  for (VectorX* vector : {&residual_.lambda, &dlambda_, &rhs_lambda_}) vector->setZero(pressures);
  for (const model::PrescribedDof& support : loading_.supports) state_.u[support.dof] = support.value;
  trial_ = state_;
  now_ = evaluate(state_);
  if (inertia_) {
    inertia_->set_internal(internal_);
    now_ = evaluate(state_);
  }
  good_ = state_;
  idle_frames_ = 0;
  cautious_ = false;
}

void LiveEquilibrium::follow(std::shared_ptr<const model::Model> model, model::Loading loading, model::State state,
                             const TornModel& torn) {
  model_ = std::move(model);
  loading_ = std::move(loading);
  if (inertia_) inertia_->follow(*model_, torn.copied, state_.u, state.u);
  state_ = std::move(state);
  free_ = model::free_dofs(model_->space(), loading_);
  linear_.follow(model_, free_, state_, torn);
  make_room();
  if (!held_) return;
  answer_.follow(torn.copied);
  linear_.set_constraint(held_);
  build_tangent();
  answer_.turn(linear_.rotation(), free_);
  refresh_answer(options_.worn_answer, options_.iterations);
  update_compliance();
  now_ = evaluate(state_);
  correct_force();
}

Vec3 LiveEquilibrium::point() const { return held_ ? held_->of(state_.u) : Vec3::Zero(); }

LiveEquilibrium::Trial LiveEquilibrium::evaluate(const model::State& state) {
  Trial out;
  out.evaluation = model_->residual(state, *scratch_, residual_);
  internal_ = residual_.u;
  model::external_force(loading_, model_->space(), state.u, 1.0 / scale(), external_);
  if (inertia_) inertia_->add_force(state.u, external_);
  residual_.u -= external_;
  if (held_) {
    multiplier_ = held_->of(residual_.u) / held_->weight.squaredNorm();
    held_->add(-multiplier_, residual_.u);
    held_->add(multiplier_, external_);
  }
  double square = 0.0;
  for (const std::int32_t dof : free_.dof) square += residual_.u[dof] * residual_.u[dof];
  out.norm = std::sqrt(square);
  out.scale = std::max({internal_.norm(), external_.norm(), small_force_});
  if (inertia_) out.scale = std::max(out.scale, inertia_->force_for(kSmallStep * size_of_body_));
  out.relative = out.scale > 0.0 ? out.norm / out.scale : 0.0;
  return out;
}

bool LiveEquilibrium::is_admissible(const Trial& trial) const {
  return trial.evaluation.finite && std::isfinite(trial.norm) &&
         (model_->allows_inversion() || trial.evaluation.inverted_tets == 0);
}

void LiveEquilibrium::build_tangent() {
  model_->tangent(state_, *scratch_, tangent_);
  model::subtract_load_stiffness(loading_, model_->space(), state_.u, 1.0 / scale(), tangent_);
  if (inertia_) inertia_->add_tangent(tangent_);
  linear_.set_tangent(tangent_, state_);
}

int LiveEquilibrium::refresh_answer(double tolerance, int most) {
  const PointAnswer::Report report =
      answer_.refresh(tangent_, free_, linear_, {.residual = tolerance, .iterations = most});
  worn_ = worn_ || report.worn;
  return report.iterations;
}

void LiveEquilibrium::update_compliance() {
  const Mat3 C = answer_.compliance();
  if (!C.inverse().allFinite()) return;  // that of before, until there is an answer
  compliance_ = 0.5 * (C + C.transpose());
  stiffness_ = compliance_.inverse();
  from_gap_ = C.inverse();
  const double small_force = kSmallMove * size_of_body_ * stiffness_.norm();
  small_force_ = small_force_ > 0.0 ? std::min(small_force_, small_force) : small_force;
}

void LiveEquilibrium::hold(const HeldPoint& point) {
  for (int k = 0; k < point.count; ++k) {
    for (const model::PrescribedDof& support : loading_.supports)
      RHEXIS_CHECK(support.dof / 3 != point.node[static_cast<std::size_t>(k)], "node {} is held by a support",
                   support.dof / 3);
  }
  held_ = point;
  small_force_ = 0.0;
  force_.setZero();
  linear_.set_constraint(held_);
  build_tangent();
  answer_.begin(point, linear_);
  refresh_answer(kFirstAnswer * options_.worn_answer, kMostFirstIterations);
  update_compliance();
  now_ = evaluate(state_);
}

void LiveEquilibrium::let_go() {
  held_.reset();
  linear_.set_constraint(std::nullopt);
  force_.setZero();
  now_ = evaluate(state_);
  good_ = state_;
  idle_frames_ = 0;
}

const Inertia& LiveEquilibrium::inertia() const {
  RHEXIS_CHECK(inertia_, "a body without mass");
  return *inertia_;
}

void LiveEquilibrium::set_motion(Motion motion) {
  RHEXIS_CHECK(inertia_ && motion.u.size() == state_.u.size(), "another body");
  inertia_->set_motion(std::move(motion));
  now_ = evaluate(state_);
}

bool LiveEquilibrium::moves() const {
  return inertia_ && inertia_->momentum(state_.u) > wanted_residual() * now_.scale;
}

bool LiveEquilibrium::begin_step() {
  RHEXIS_CHECK(inertia_, "a body without mass");
  if (!(now_.relative <= options_.tolerance)) return false;
  now_ = evaluate(state_);  // whose internal force it needs
  inertia_->begin(state_.u, internal_);
  now_ = evaluate(state_);
  good_ = state_;
  idle_frames_ = 0;
  begun_ = true;
  return true;
}

Vec3 LiveEquilibrium::velocity() const {
  RHEXIS_CHECK(inertia_ && held_, "without mass, or not held");
  return (held_->of(state_.u) - held_->of(inertia_->motion().u)) / inertia_->step();
}

Vec3 LiveEquilibrium::force_rate() const {
  RHEXIS_CHECK(inertia_ && held_, "without mass, or not held");
  return (held_->of(internal_) - held_->of(inertia_->motion().internal)) /
         (held_->weight.squaredNorm() * inertia_->step());
}

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

/// Z is turned with the body to where it will be half way along `gap`: on an arc the chord has the direction of its
/// middle, and what a straight step stretches a body by that only turns is kappa / mu times as much in its forces. Not
/// of laws that let tets turn inside out: St. Venant-Kirchhoff's gives way where it is pressed, and that stretch keeps
/// a fast hand from there.
void LiveEquilibrium::turn_half_way(const Vec3& gap) {
  if (gap.isZero(0.0) || model_->allows_inversion()) return;
  trial_ = state_;
  answer_.add(0.5 * (from_gap_ * gap), trial_);
  linear_.measure(trial_.u, half_way_);
  answer_.turn(half_way_, free_);
  update_compliance();
}

/// The first guess: the last tangent's answer to the move of the hand, shortened where a tet would invert. False: there
/// is none.
bool LiveEquilibrium::follow(const Vec3& hand, LiveFrame& frame) {
  const Vec3 whole = hand - held_->of(state_.u);
  Trial next;
  for (int halving = 0; halving <= kHalvings; ++halving) {
    const Vec3 gap = std::ldexp(1.0, -halving) * whole;
    turn_half_way(gap);
    trial_ = state_;
    answer_.add(from_gap_ * gap, trial_);
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
  if (held_) answer_.turn(linear_.rotation(), free_);
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
