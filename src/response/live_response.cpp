#include "response/live_response.h"

#include <algorithm>
#include <array>
#include <utility>

#include <Eigen/Eigenvalues>

#include "base/check.h"
#include "base/clock.h"
#include "element/linear_tet.h"
#include "response/carried_state.h"
#include "response/followed.h"
#include "solver/equilibrium.h"

namespace rhexis::response {
namespace {

/// Of the body's size: the way of a frame of what is let go, and where it is as good as free.
constexpr double kLongestStep = 0.03;
constexpr double kFree = 1e-3;
/// Time steps that a body may be behind: more is not made up for.
constexpr double kMostOwed = 2.0;
/// Two times that differ by less are the same, s.
constexpr double kSameTime = 1e-9;
/// Times that a body without a hand gives up, or is near rest with tets inside out, before it begins again from rest.
constexpr int kMostGivenUp = 2;

/// Another frame like it would do nothing else.
bool is_stuck(const solver::LiveFrame& frame) {
  return frame.reached && !frame.gave_up && frame.corrections == 0 && frame.linear_iterations == 0;
}

/// The least of its eigenvalues as a part of the largest: a body that is about to give way has a softness without
/// bound, or below zero, and the haptic loop is to have a law that pulls back.
constexpr double kLeastSoftness = 1e-3;

Mat3 made_definite(const Mat3& compliance) {
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(compliance);
  Vec3 value = solver.eigenvalues().cwiseAbs();
  value = value.cwiseMax(kLeastSoftness * value.maxCoeff());
  return solver.eigenvectors() * value.asDiagonal() * solver.eigenvectors().transpose();
}

bool acts(const model::Loading& loading) {
  return !loading.dead_force.isZero(0.0) || !loading.pressures.empty() ||
         std::any_of(loading.supports.begin(), loading.supports.end(),
                     [](const model::PrescribedDof& support) { return support.value != 0.0; });
}

}  // namespace

Expected<std::unique_ptr<LiveResponse>> LiveResponse::make(const mesh::TornMesh& mesh, LiveResponseSettings settings) {
  if (settings.dynamics) settings.live = solver::moving(settings.live);
  std::unique_ptr<LiveResponse> out(new LiveResponse(mesh, std::move(settings)));
  out->make_model();
  Expected<model::State> state = out->equilibrium_from_rest();
  if (!state) return fail(std::move(state.error()));
  const mesh::BoundingBox box = mesh::bounding_box(mesh.mesh());
  out->size_ = box.size().norm();
  out->make_live(std::move(*state));
  out->energy_at_first_ = out->potential_energy();
  out->update_contact();
  return out;
}

/// Of the present topology, under the loads alone; pieces out of the solve stay where they are.
Expected<model::State> LiveResponse::equilibrium_from_rest() const {
  model::State state = model_->initial_state();
  VectorX where = state.u;
  if (live_) {
    where = live_->state().u;
    for (const model::PrescribedDof& held : live_->loading().supports) state.u[held.dof] = held.value;
  }
  const model::Loading loading = make_torn_loading(mesh_, settings_.body, model_->space(), where);
  if (!acts(loading)) {
    state.lambda.setZero();
    return state;
  }
  const solver::Report report = solver::solve_equilibrium(*model_, loading, settings_.solver, state);
  if (!report.converged())
    return fail("the body finds no equilibrium under its loads: " + report.why, "smaller loads, or another model");
  return state;
}

void LiveResponse::make_live(model::State state) {
  model::Loading loading = make_torn_loading(mesh_, settings_.body, model_->space(), state.u);
  live_ = std::make_unique<solver::LiveEquilibrium>(model_, std::move(loading), std::move(state), settings_.live,
                                                    settings_.dynamics);
}

void LiveResponse::make_model() {
  left_out_ = tets_left_out(mesh_);
  model_ = model::make_model(mesh_.mesh(), settings_.body.model, left_out_);
}

void LiveResponse::grasp(std::span<const NodeId> nodes) {
  RHEXIS_CHECK(nodes.empty(), "{} nodes, and no point", nodes.size());
  if (live_->holds() && point_) {
    if (settings_.dynamics) {
      live_->let_go();
    } else {
      leaving_ = point_;
    }
  }
  point_.reset();
  update_contact();
}

void LiveResponse::hold(const SurfacePoint& point, ContactMode mode) {
  let_go();
  point_ = point;
  mode_ = mode;
  take_hold();
}

void LiveResponse::let_go() {
  if (live_->holds()) live_->let_go();
  leaving_.reset();
}

void LiveResponse::take_hold() {
  solver::HeldPoint held;
  held.count = point_->count;
  held.weight = point_->weight;
  supported_ = false;
  for (int k = 0; k < held.count; ++k) {
    const auto i = static_cast<std::size_t>(k);
    held.node[i] = point_->node[i].value();
    const std::int32_t original = mesh_.original(point_->node[i]).value();
    const auto& supports = settings_.body.body.supports;
    supported_ = supported_ || !mesh_.is_solved(point_->node[i]) ||
                 std::any_of(supports.begin(), supports.end(),
                             [&](const model::PrescribedDof& support) { return support.dof / 3 == original; });
  }
  if (!supported_) {
    live_->hold(held);
    led_to_ = live_->point();
  }
  update_contact();
}

/// N u = p of a point whose nodes share what it gives way by: L = W^T C W / |w|^4, so that N L N^T = C, and the rest
/// p - C f, from where the tangent counts. With mass C is that of a whole step, and p and f are those of its beginning:
/// they go on with time as the next step will have them if every node keeps its velocity, else a hand that only goes on
/// would feel the damping and inertia of a move out of rest, and lose them when the step begins.
void LiveResponse::update_contact() {
  const Eigen::Index count = point_ ? 3 * point_->count : 0;
  compliance_.setZero(count, count);
  rest_.setZero(count);
  if (!live_->holds() || !point_) return;
  const double square = point_->weight.squaredNorm();
  const Mat3 C = made_definite(live_->compliance());
  Vec3 rest = live_->point() - C * live_->force();
  if (settings_.dynamics)
    rest += std::min(owed_, settings_.dynamics->step) * (live_->velocity() - C * live_->force_rate());
  for (int a = 0; a < point_->count; ++a) {
    rest_.segment<3>(3 * a) = rest;
    for (int b = 0; b < point_->count; ++b)
      compliance_.block<3, 3>(3 * a, 3 * b) = point_->weight[a] * point_->weight[b] / (square * square) * C;
  }
}

/// Where the point has to be. Pushed at, it slides aside until there is no force across the normal, and lies where the
/// loads put it while nothing presses.
Vec3 LiveResponse::target(const Vec3& hand) const {
  if (mode_ == ContactMode::hold) return hand;
  const Mat3 C = made_definite(live_->compliance());
  const Vec3& n = point_->normal;
  const Vec3 rest = live_->point() - C * live_->force();
  const double force = n.dot(hand - rest) / n.dot(C * n);
  return rest + std::min(0.0, force) * (C * n);
}

/// What the point would give way by if nothing held it; downhill also where it is about to snap.
Vec3 LiveResponse::way_back() const { return made_definite(live_->compliance()) * live_->force(); }

/// Some way to where nothing would hold the point: a body that is let go far from rest comes back in steps that its
/// tangent can tell.
Vec3 LiveResponse::released() const {
  Vec3 way = way_back();
  const double longest = kLongestStep * size_;
  if (way.norm() > longest) way *= longest / way.norm();
  return live_->point() - way;
}

void LiveResponse::pass(double seconds) {
  if (settings_.dynamics) owed_ = std::min(owed_ + seconds, kMostOwed * settings_.dynamics->step);
}

/// Once its time has come, and the step before has ended. False: it has not yet.
bool LiveResponse::begin_step() {
  if (owed_ <= settings_.dynamics->step - kSameTime || !live_->begin_step()) return false;
  owed_ -= settings_.dynamics->step;
  return true;
}

MoveReport LiveResponse::move(const Vec3& hand) {
  MoveReport out;
  if (!settings_.dynamics || begin_step()) led_to_ = hand;
  for (int k = 0; k < settings_.frames; ++k) {
    solver::LiveFrame frame;
    double tolerance = settings_.live.tolerance;
    bool inside_out = false;  // laws without a wall at J = 0 have equilibria there that no body has
    if (point_ && live_->holds()) {
      frame = live_->step(target(led_to_));
    } else if (leaving_) {
      frame = live_->step(released());
      const bool is_free = frame.reached && way_back().norm() <= kFree * size_;
      if (is_free || !frame.trouble.empty()) let_go();
      out.at_rest = false;
      out.late = frame.trouble;
      continue;
    } else {
      frame = live_->settle();
      tolerance = std::min(tolerance, settings_.live.at_rest);
      // With mass it is halted where it is and goes on from there: to begin again would take it elsewhere at once.
      if (!settings_.dynamics) {
        inside_out = frame.residual <= settings_.live.late && live_->inverted_tets() > inverted_from_rest_;
        if (frame.gave_up || inside_out) ++given_up_;
      }
      if (given_up_ == kMostGivenUp) begin_again();
    }
    out.at_rest = frame.reached && frame.corrections == 0 && frame.linear_iterations == 0 &&
                  frame.residual <= tolerance && !inside_out && !live_->moves() && (led_to_ == hand || !live_->holds());
    if (out.at_rest) given_up_ = 0;
    out.late = frame.trouble;
    if (out.at_rest || is_stuck(frame)) break;
  }
  out.near = live_->residual() <= settings_.live.late;
  update_contact();
  return out;
}

/// What nobody holds and does not come to rest from where it is does so from the undeformed body, where there is a way.
void LiveResponse::begin_again() {
  given_up_ = 0;
  if (Expected<model::State> state = equilibrium_from_rest()) make_live(std::move(*state));
  inverted_from_rest_ = live_->inverted_tets();
}

DeformedTet LiveResponse::deformed(TetId tet) const {
  const mesh::TetMesh& mesh = mesh_.mesh();
  std::array<Vec3, 4> u;
  for (std::size_t a = 0; a < 4; ++a) u[a] = state().u.segment<3>(3 * Eigen::Index{mesh.tet(tet)[a].value()});
  DeformedTet out;
  out.F += element::displacement_gradient(element::make_linear_tet(mesh::corners(mesh, tet)), u);
  out.state = model_->tet_state(state(), tet, out.F);
  return out;
}

FollowReport LiveResponse::follow(const mesh::MeshEdit& edit, std::span<const Focus> /*focus*/,
                                  const CrackAdvance* /*advance*/) {
  const Stopwatch watch;
  FollowReport report;
  std::optional<model::State> state =
      carried_state(model_->space(), left_out_, this->state(), mesh_, edit, model_->allows_inversion());
  if (!state) {
    report.ok = false;
    report.why = "the cut would turn a tet inside out in the deformed body";
    return report;
  }
  before_.push_back(
      {this->state(), point_ ? point_ : leaving_, settings_.dynamics ? inertia().motion() : solver::Motion{}});
  linalg::ElementChange change;
  add_applied(mesh_, edit, change);
  make_model();
  model::Loading loading = make_torn_loading(mesh_, settings_.body, model_->space(), state->u);
  const std::optional<SurfacePoint>& held = point_ ? point_ : leaving_;
  for (int k = 0; held && k < held->count; ++k) {
    if (mesh_.is_solved(held->node[static_cast<std::size_t>(k)])) continue;
    let_go();
    break;
  }
  live_->follow(model_, std::move(loading), std::move(*state),
                {.copied = std::move(change.copied), .touched = std::move(change.touched)});
  update_contact();
  report.update_seconds = watch.seconds();
  return report;
}

void LiveResponse::go_back(const mesh::MeshEdit& /*edit*/, std::span<const Focus> /*focus*/) {
  RHEXIS_CHECK(!before_.empty(), "no edit was followed");
  Before before = std::move(before_.back());
  before_.pop_back();
  make_model();
  make_live(std::move(before.state));
  if (settings_.dynamics) live_->set_motion(std::move(before.motion));
  leaving_.reset();
  if (point_) {
    take_hold();
  } else if (before.point && !settings_.dynamics) {  // the hand is not there any more
    point_ = before.point;
    take_hold();
    if (live_->holds()) leaving_ = point_;
    point_.reset();
  }
  update_contact();
}

void LiveResponse::displacement(std::span<const NodeId> nodes, const VectorX& /*held_forces*/, double loads,
                                VectorX& out) {
  RHEXIS_CHECK(loads == 1.0, "{} of the loads", loads);
  out.resize(static_cast<Eigen::Index>(3 * nodes.size()));
  for (std::size_t i = 0; i < nodes.size(); ++i)
    out.segment<3>(static_cast<Eigen::Index>(3 * i)) = state().u.segment<3>(3 * Eigen::Index{nodes[i].value()});
}

void LiveResponse::whole_displacement(const VectorX& /*held_forces*/, double loads, VectorX& out) {
  RHEXIS_CHECK(loads == 1.0, "{} of the loads", loads);
  out = state().u;
}

double LiveResponse::potential_energy() const {
  return model_->energy(state()) - live_->loading().dead_force.dot(state().u);
}

double LiveResponse::stored_energy(const VectorX& /*held_forces*/) { return potential_energy() - energy_at_first_; }

std::size_t LiveResponse::memory_bytes() const {
  std::size_t bytes = live_->memory_bytes();
  for (const Before& before : before_)
    bytes += sizeof(double) *
             static_cast<std::size_t>(before.state.u.size() + before.state.lambda.size() + 3 * before.motion.u.size());
  return bytes;
}

}  // namespace rhexis::response
