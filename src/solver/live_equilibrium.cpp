#include "solver/live_equilibrium.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "base/check.h"

namespace rhexis::solver {
namespace {

/// Of worn_answer: the residual to which Z is solved for when the hand takes hold; the frames in which it does not move
/// yet bring it further. In so many iterations at most: a body that is taken hold of while it comes back from far has a
/// preconditioner that is worn.
constexpr double kFirstAnswer = 0.5;
constexpr int kMostFirstIterations = 24;
/// Of the body's size: what takes less force to move the hand by is near to rest, and a residual is held against that.
constexpr double kSmallMove = 0.01;
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
  answer_.turn(linear_, free_);
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

}  // namespace rhexis::solver
